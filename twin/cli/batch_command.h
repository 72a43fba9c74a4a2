// twin/cli/batch_command.h - `kerf batch WHAT.. --out DIR`: many programs, each run by itself.
#pragma once

#include "twin/config/written_options.h"

namespace kerf {

/// The exit code: the worst of the runs; kExitFailure where the batch has not come to its end.
int batch_command(const Arguments& arguments);

/// `kerf batch-unit FILE`: one run of a batch, for an engine (run_unit_file()); in no list of
/// commands. kExitGood: its result is written, whatever it is.
int batch_unit_command(const std::string& path);

}  // namespace kerf
