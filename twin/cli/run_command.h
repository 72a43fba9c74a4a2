// twin/cli/run_command.h - `kerf run`.
#pragma once

#include <functional>

#include "base/exit_code.h"
#include "twin/cli/page_output.h"
#include "twin/cli/run_options.h"
#include "twin/report/finding_lists.h"

namespace kerf {

/// How one of the programs ended.
struct RunVerdict {
  int code = kExitGood;
  bool interrupted = false;
  ListedProgram listed;    ///< for --junit and --sarif
  bool is_listed = false;  ///< those are written already
};

/// A run that has a report, all of it done and written.
struct FinishedRun {
  Session& session;
  Outcome outcome;
  int code;
  const PageFacts& page;  ///< whole with RunRequest::keeps_page alone
};
using RunListener = std::function<void(const FinishedRun&, Diagnostics&)>;

/// One program: cut, compared, its files written, its findings and its summary printed. `finished`
/// hears of one that came to a report before what it adds to the diagnostics is printed.
RunVerdict run_one(const Arguments& arguments, RunRequest request,
                   const RunListener& finished = {});

/// Runs, reports, writes. Returns the exit code.
int run_command(const Arguments& arguments);

}  // namespace kerf
