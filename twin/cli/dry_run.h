// twin/cli/dry_run.h - a program run through in the background, as `kerf run` does it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "interp_bridge/private_folder.h"
#include "twin/batch/bounded_process.h"
#include "twin/config/written_options.h"
#include "twin/findings/finding.h"

namespace kerf {

struct DryRunResult {
  std::string program;
  bool is_done = false;           ///< to its end; else `trouble` says why not
  std::vector<Finding> findings;  ///< errors and warnings; their file is `program` or one it calls
  int errors = 0;
  int warnings = 0;
  double duration_s = -1;
  std::string trouble;

  bool is_good() const { return is_done && errors == 0; }
};

/// One line: "part.ngc: dry run: no findings, 12 min 30 s".
std::string line_of(const DryRunResult& result);

/// Of the report's JSON (kerf-report/1). Nothing: it is none.
std::optional<DryRunResult> dry_run_result(const std::string& program, const std::string& json);

/// A `kerf run` of its own, at the lowest priority there is (SCHED_IDLE): what is left of the
/// processor by the machine, and by whoever watches it.
class DryRun {
 public:
  /// `options`: those of a watch; what `kerf run` has, too, is passed on to it.
  static Result<DryRun> start(const std::string& program, const WrittenOptions& options);
  /// The result, once; nothing as long as it runs.
  std::optional<DryRunResult> look();

 private:
  DryRun(std::string program, PrivateFolder folder)
      : program_(std::move(program)), folder_(std::move(folder)) {}

  std::string program_;
  PrivateFolder folder_;                   // goes after what writes into it
  std::optional<BoundedProcess> process_;  ///< ended by its destructor
};

}  // namespace kerf
