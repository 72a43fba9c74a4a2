// twin/cli/batch_command.h - `kerf batch WHAT.. --out DIR`: many programs, each run by itself.
#pragma once

#include "twin/config/written_options.h"

namespace kerf {

/// The exit code: the worst of the runs; kExitFailure where the batch has not come to its end.
int batch_command(const Arguments& arguments);

}  // namespace kerf
