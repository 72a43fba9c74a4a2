// twin/cli/config_command.h - `kerf config`: check, print, schema, completion, man.
#pragma once

#include "twin/config/written_options.h"

namespace kerf {

/// check: says what is wrong, or that all is well. print: the configuration with all defaults.
/// schema: every key with unit, range, default. completion: a script for the shell that FILE
/// names. man: the manual page. Returns the exit code.
int config_command(const Arguments& arguments);

}  // namespace kerf
