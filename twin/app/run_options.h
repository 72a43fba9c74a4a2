// twin/app/run_options.h - the command line of `kerf run`, from text to checked values.
#pragma once

#include <string>

#include "base/diagnostic.h"
#include "twin/app/outputs.h"
#include "twin/app/program_options.h"
#include "twin/app/torch_options.h"
#include "twin/app/work_options.h"
#include "twin/session.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct RunArguments {
  ProgramArguments source;
  WorkArguments work;
  TorchArguments torch;
  std::string mesh_tolerance;
  std::string from_line;
  std::string until_line;
  OutputPaths outputs;
  bool view = false;
  bool quiet = false;
};

/// The same, understood.
struct RunRequest {
  SessionOptions session;
  OutputPaths outputs;
  double mesh_tolerance_mm = 0.01;
  bool view = false;  ///< in a window, when it is done
  bool quiet = false;
};

/// All faults at once, as diagnostics: "--cell: '0' is not allowed; must be above 0 and at most
/// 1000 (mm)".
RunRequest understand(const RunArguments& arguments, Diagnostics& diagnostics);

}  // namespace kerf
