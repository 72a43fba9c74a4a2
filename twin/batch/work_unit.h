// twin/batch/work_unit.h - the run of one program of a batch: here, or from a file elsewhere.
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/result.h"
#include "twin/batch/batch_result.h"
#include "twin/batch/bounded_process.h"

namespace kerf {

/// What one run needs. A computer that sees the same folders can do it.
struct WorkUnit {
  std::string folder;  ///< that all paths here are relative to
  std::string out;     ///< of the batch
  std::string program;
  std::string hash;                ///< content_hash(), when the batch began
  std::vector<std::string> words;  ///< of `kerf run`, behind the program
  ProcessBounds bounds;
  int threads = 1;  ///< where the words do not say --threads
};

/// One line of JSON, and back. Error: it is none of ours.
std::string text_of(const WorkUnit& unit);
Result<WorkUnit> unit_of_text(const std::string& text);

/// Starts it in the present folder, with the files of an earlier run removed first.
Result<BoundedProcess> start_unit(const WorkUnit& unit);
BatchResult result_of_unit(const WorkUnit& unit, const ProcessEnd& end);

/// `kerf batch-unit FILE`, which engines call: reads the unit, goes to its folder, runs it, and
/// leaves line_of() its result beside FILE, under result_name(FILE). A run that fails is a result.
/// Error: there is none; so it is where `stop` ended the run.
Done run_unit_file(const std::string& path, const std::stop_token& stop);

/// "work/00012.unit" -> "work/00012.result"
std::string result_name(const std::string& unit_path);

}  // namespace kerf
