// twin/app/live_options.h - the command lines of `kerf shadow` and `kerf replay`, from text and
// configuration to checked values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "twin/app/outputs.h"
#include "twin/app/program_options.h"
#include "twin/app/torch_options.h"
#include "twin/app/work_options.h"
#include "twin/config/live_config.h"
#include "twin/live/live_session.h"
#include "viewer/scene.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct LiveArguments {
  ProgramArguments source;  ///< source.program is --program
  WorkArguments work;
  TorchArguments torch;
  std::string config;
  std::vector<std::string> sets;
  std::string log;     ///< replay
  std::string speed;   ///< replay
  std::string pins;    ///< replay
  std::string record;  ///< shadow
  std::string for_s;
  std::string gap;
  std::string look_ahead;
  std::string joined_late;
  std::string on_program_end;
  std::vector<std::string> next_programs;
  std::string off_path;
  std::string events;
  std::string cpu_limit;     ///< shadow
  std::string memory_limit;  ///< shadow
  std::string mesh_tolerance;
  std::string draw;  ///< by which road the window draws
  OutputPaths outputs;
  bool quiet = false;
  bool no_view = false;
  bool in_window = false;            ///< `kerf view LOG`: with a window or not at all
  std::vector<std::string> command;  ///< all of it as written, kerf itself first
};

/// The same, understood.
struct LiveRequest {
  LiveConfig config;
  LiveOptions options;                 ///< all but the frame, which the source has a say in
  LengthUnit units = LengthUnit::kMm;  ///< of what is shown
  bool inch_machine = false;
  std::string joint_letters;   ///< of the INI
  std::string parameter_path;  ///< of the INI
  std::string ini;             ///< empty: none
  OutputPaths outputs;
  std::string record;
  std::string events;
  double mesh_tolerance_mm = 0.01;
  double cpu_limit_percent = 0;  ///< 0: none
  double memory_limit_mb = 0;    ///< 0: none
  bool quiet = false;
  bool window = false;           ///< wanted; there may be no display
  std::optional<DrawRoad> draw;  ///< in the window; none: as it remembers it
  bool needs_window = false;     ///< without one there is nothing to be done
};

enum class LiveCommand { kShadow, kReplay };

/// All faults at once, as diagnostics. What the command line says goes before what the
/// configuration says.
LiveRequest understand_live(const LiveArguments& arguments, LiveCommand command,
                            Diagnostics& diagnostics);

/// How the samples of `source` are to be read: completes request.options.cutting.
void choose_frame(LiveRequest& request, const PositionSource& source, Diagnostics& diagnostics);

}  // namespace kerf
