// twin/cli/job_command.h - `kerf job`.
#pragma once

#include <memory>
#include <optional>

#include "twin/cli/job_run.h"
#include "twin/config/written_options.h"

namespace kerf {

/// Runs the setups of a job file. The exit code is the worst of them.
int job_command(const Arguments& arguments);

/// `kerf view JOB --setup N`: those before it have been run, unseen; the command line that shows
/// it, while `run` lives. Nothing: what is wrong has been said, and `code` is the exit code.
std::optional<Arguments> view_of_job(const Arguments& arguments, std::unique_ptr<JobRun>& run,
                                     int& code);

}  // namespace kerf
