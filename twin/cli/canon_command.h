// twin/cli/canon_command.h - `kerf canon`: what the program commands, as JSON lines.
#pragma once

#include "twin/config/written_options.h"

namespace kerf {

/// Interprets the program and writes a line for each motion (twin/machine/motion_json.h) as they
/// come. Diagnostics of the interpreter go to stderr. Returns the exit code.
int canon_command(const Arguments& arguments);

}  // namespace kerf
