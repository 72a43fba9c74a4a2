// twin/cli/run_options.h - the command line of `kerf run`, from text to checked values.
#pragma once

#include <optional>
#include <string>

#include "base/diagnostic.h"
#include "twin/cli/compare_option.h"
#include "twin/cli/outputs.h"
#include "twin/cli/program_options.h"
#include "twin/cli/torch_options.h"
#include "twin/cli/work_options.h"
#include "twin/config/live_config.h"
#include "twin/machines/machine_choice.h"
#include "twin/serve/serve_address.h"
#include "twin/session/entry_check.h"
#include "twin/session/session.h"
#include "viewer/scene.h"

namespace kerf {

/// `kerf run`, understood.
struct RunRequest {
  SessionOptions session;
  OutputPaths outputs;
  double mesh_tolerance_mm = 0;
  std::string finding_png;            ///< a folder; empty: no pictures of findings
  bool view = false;                  ///< in a window, when it is done
  std::optional<DrawMode> draw;       ///< in that window; none: as it remembers it
  MachineChoice machine;              ///< drawn there, around the workpiece
  std::string ini;                    ///< of that machine; empty: none is given
  EntryWish entry;                    ///< a start in the middle
  CompareRequest compare;             ///< the finished part with its design
  bool engagement = false;            ///< how tools are engaged is measured
  std::optional<ServeAddress> serve;  ///< a page for who looks on
  bool quiet = false;
  bool verbose = false;
  bool keeps_moves = false;            ///< for a comparison that comes after another setup
  bool keeps_page = false;             ///< what a page tells is kept: FinishedRun::page
  bool is_of_job = false;              ///< one of several setups: no command line says all of it
  bool summary_on_stderr = false;      ///< standard output is that of a file
  LengthUnit units = LengthUnit::kMm;  ///< of what is shown
  Arguments written;                   ///< what all this was understood from
};

/// The configuration that --config and --set make; nothing: there is none, or it has faults.
std::optional<LiveConfig> read_config(const WrittenOptions& options, Diagnostics& diagnostics);
/// The layers of a command line over a configuration; null: there is none.
OptionLayers layers_of(const Arguments& arguments, const LiveConfig* config);
/// What a configuration says of the machine that no option says.
ProgramSurroundings surroundings_of(const LiveConfig* config);

/// What `kerf run` and `kerf view` have in common, from the reader's layers.
RunRequest understand_cut(const LiveConfig* config, OptionReader& reader);

/// All faults at once, as diagnostics: "--cell: '0' is not allowed; must be above 0 and at most
/// 1000 (mm)".
RunRequest understand_run(const Arguments& arguments, Diagnostics& diagnostics);

}  // namespace kerf
