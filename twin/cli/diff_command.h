// twin/cli/diff_command.h - `kerf diff A B`: what differs between two programs or workpieces.
#pragma once

#include "twin/config/written_options.h"

namespace kerf {

/// The exit code: kExitGood if they are the same, kExitFindings if not.
int diff_command(const Arguments& arguments);

}  // namespace kerf
