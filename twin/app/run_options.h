// twin/app/run_options.h - the command line of `kerf run`, from text to checked values.
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
#include "twin/machine_model/machine_choice.h"
#include "twin/session.h"
#include "viewer/scene.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct RunArguments {
  std::string config;                 ///< of `kerf run`; other commands read theirs themselves
  std::vector<std::string> sets;      ///< likewise
  std::vector<std::string> programs;  ///< of `kerf run`; empty: source.program alone
  ProgramArguments source;
  WorkArguments work;
  TorchArguments torch;
  std::string mesh_tolerance;
  std::string from_line;
  std::string until_line;
  OutputPaths outputs;
  bool view = false;
  std::string draw;  ///< of `kerf run`; `kerf view` has its own
  bool quiet = false;
  bool verbose = false;
  bool no_guess = false;
  std::string kerf = "kerf";  ///< by which name it was called
};

/// The same, understood.
struct RunRequest {
  SessionOptions session;
  OutputPaths outputs;
  double mesh_tolerance_mm = 0.01;
  bool view = false;             ///< in a window, when it is done
  std::optional<DrawRoad> draw;  ///< in that window; none: as it remembers it
  MachineChoice machine;         ///< drawn there, around the workpiece
  std::string ini;               ///< of that machine; empty: none is given
  bool quiet = false;
  bool verbose = false;
  LengthUnit units = LengthUnit::kMm;  ///< of what is shown
  RunArguments written;                ///< what all this was understood from
};

/// What the configuration says of machine, beam, tools and blank, where the command line does not.
/// `unit`: of the arguments.
void complete_arguments(const LiveConfig& config, LengthUnit unit, RunArguments& arguments);
void complete_session(const LiveConfig& config, const RunArguments& arguments,
                      SessionOptions& session);

/// All faults at once, as diagnostics: "--cell: '0' is not allowed; must be above 0 and at most
/// 1000 (mm)".
RunRequest understand(const RunArguments& arguments, Diagnostics& diagnostics);

}  // namespace kerf
