// twin/cli/run_ends.h - how a run that is a means to something else has ended.
#pragma once

#include "base/diagnostic.h"
#include "twin/findings/outcome.h"
#include "twin/report/report.h"

namespace kerf {

/// Its exit code; findings do not count.
int end_code(Outcome outcome, const Diagnostics& diagnostics);

/// What stopped its program, to stderr: the interpreter's own errors.
void print_stops(const Report& report);

}  // namespace kerf
