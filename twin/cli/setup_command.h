// twin/cli/setup_command.h - `kerf setup INI`: a tab with kerf in LinuxCNC's screen.
#pragma once

#include "twin/config/written_options.h"

namespace kerf {

/// Shows the lines as a diff, or writes them. The exit code.
int setup_command(const Arguments& arguments);

}  // namespace kerf
