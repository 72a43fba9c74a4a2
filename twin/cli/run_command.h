// twin/cli/run_command.h - `kerf run`.
#pragma once

#include "twin/cli/run_options.h"

namespace kerf {

/// Runs, reports, writes. Returns the exit code.
int run_command(const Arguments& arguments);

}  // namespace kerf
