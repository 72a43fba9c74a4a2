// twin/cli/job_command.h - `kerf job`.
#pragma once

#include "twin/config/written_options.h"

namespace kerf {

/// Runs the setups of a job file. The exit code is the worst of them.
int job_command(const Arguments& arguments);

}  // namespace kerf
