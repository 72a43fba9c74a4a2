// twin/app/run_command.h - `kerf run`.
#pragma once

#include "twin/app/run_options.h"

namespace kerf {

/// Runs, reports, writes. Returns the exit code.
int run_command(const RunArguments& arguments);

}  // namespace kerf
