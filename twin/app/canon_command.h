// twin/app/canon_command.h - `kerf canon`: what the program commands, as JSON lines.
#pragma once

#include <string>

#include "twin/app/program_options.h"

namespace kerf {

struct CanonArguments {
  ProgramArguments source;
  std::string out = "-";
  bool quiet = false;
};

/// Interprets the program and writes a line for each motion (twin/motion_json.h) as they come.
/// Diagnostics of the interpreter go to stderr. Returns the exit code.
int canon_command(const CanonArguments& arguments);

}  // namespace kerf
