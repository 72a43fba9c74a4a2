// twin/cli/live_options.h - the command lines of `kerf shadow` and `kerf replay`, from text and
// configuration to checked values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/diagnostic.h"
#include "twin/cli/compare_option.h"
#include "twin/cli/outputs.h"
#include "twin/cli/program_options.h"
#include "twin/cli/tab_guard.h"
#include "twin/cli/torch_options.h"
#include "twin/cli/work_options.h"
#include "twin/config/live_config.h"
#include "twin/live/live_session.h"
#include "twin/serve/serve_address.h"
#include "viewer/scene.h"

namespace kerf {

/// The options, understood.
struct LiveRequest {
  LiveConfig config;
  LiveOptions options;                 ///< all but the frame, which the source has a say in
  LengthUnit units = LengthUnit::kMm;  ///< of what is shown
  bool inch_machine = false;
  std::string joint_letters;   ///< of the INI
  std::string parameter_path;  ///< of the INI
  std::string ini;             ///< empty: none
  OutputPaths outputs;
  CompareRequest compare;  ///< what is left at the end with its design
  std::string record;
  std::string events;
  std::optional<ServeAddress> serve;  ///< a page for who looks on
  double mesh_tolerance_mm = 0;
  std::string finding_png;       ///< a folder; empty: no pictures of findings
  double cpu_limit_percent = 0;  ///< 0: none
  double memory_limit_mb = 0;    ///< 0: none
  bool quiet = false;
  bool window = false;           ///< wanted; there may be no display
  std::optional<DrawMode> draw;  ///< in the window; none: as it remembers it
  /// kerf-status, which says what LinuxCNC has loaded: that is followed. Empty: it is not.
  std::string kerf_status;
  std::string nml_file;                   ///< of the INI; empty: LinuxCNC's own
  std::optional<TabWish> tab;             ///< the window is to be in another program's
  std::optional<std::uint32_t> embed_in;  ///< the tab, once it is there
  bool needs_window = false;              ///< without one there is nothing to be done
};

/// All faults at once, as diagnostics. `arguments`: of kShadow or kReplay.
LiveRequest understand_live(const Arguments& arguments, Diagnostics& diagnostics);

/// A load that cannot be held against the material: an error, and false. None at all: a warning.
bool check_load(const LiveRequest& request, const PositionSource& source, Diagnostics& diagnostics);

/// How the samples of `source` are to be read: completes request.options.cutting.
void choose_frame(LiveRequest& request, const PositionSource& source, Diagnostics& diagnostics);

}  // namespace kerf
