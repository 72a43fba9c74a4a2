// twin/cli/job_command.h - `kerf job`.
#pragma once

#include <memory>

#include "twin/cli/view_setups.h"
#include "twin/config/written_options.h"

namespace kerf {

/// Runs the setups of a job file. The exit code is the worst of them.
int job_command(const Arguments& arguments);

/// `kerf view JOB --setup N`: those before it have been run, unseen. Null: what is wrong has been
/// said, and `code` is the exit code.
std::unique_ptr<ViewSetups> view_of_job(const Arguments& arguments, int& code);

}  // namespace kerf
