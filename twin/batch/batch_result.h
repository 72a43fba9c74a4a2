// twin/batch/batch_result.h - how one program of a batch ended: a line of results.jsonl.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/exit_code.h"
#include "twin/batch/bounded_process.h"

namespace kerf {

enum class BatchVerdict : std::uint8_t {
  kGood,         ///< finished, no finding of severity error
  kFindings,     ///< finished, with such
  kLossy,        ///< finished, but data was lost
  kUsage,        ///< its options make no sense
  kFailed,       ///< not run to its end
  kOutOfTime,    ///< ended after --each-seconds
  kOutOfMemory,  ///< it wanted more than there is, or --each-memory allows
  kCrashed,      ///< ended by a signal: a fault of kerf
};
inline constexpr std::size_t kBatchVerdicts = 8;

/// "good", "out-of-time", ..: of the JSON. Never translated.
const char* to_string(BatchVerdict verdict);
/// The exit code of kerf run that says it.
ExitCode exit_code_of(BatchVerdict verdict);

/// Names of files are those below the folder of the batch; empty: there is none.
struct BatchResult {
  std::string program;  ///< as it was written
  std::string hash;     ///< content_hash()
  BatchVerdict verdict = BatchVerdict::kFailed;
  int exit_code = -1;                                 ///< of kerf run; -1: ended by a signal
  std::uint64_t errors = 0, warnings = 0, notes = 0;  ///< of the findings that the report lists
  std::uint64_t findings = 0;                         ///< all of them
  std::optional<double> time_s;                       ///< that the machine takes
  std::optional<double> removed_mm3;
  std::string digest;   ///< of the workpiece
  std::string message;  ///< the first thing that is wrong; empty if nothing is
  std::string report, page, picture, junit;
  std::string said;  ///< what the run printed
  double wall_s = 0;
  double peak_rss_mb = 0;
  ProcessBounds bounds;  ///< that it was run in
};

/// One line, with its newline.
std::string line_of(const BatchResult& result);
/// The same for the summary: without what differs from run to run.
nlohmann::ordered_json summary_json(const BatchResult& result);
/// nullopt: no whole line of ours.
std::optional<BatchResult> result_of_line(std::string_view line);

/// What of a batch's folder belongs to one program: "programs/slot-1a2b3c4d". The same for the same
/// path, whatever else the batch runs.
std::string folder_of(const std::string& program);

/// The files that a run in `out`/folder_of(program) is asked for, as words of `kerf run`.
std::vector<std::string> output_words(const std::string& out, const std::string& program);

/// What came of a run: from its end, and from the files that it left. Reads the report.
BatchResult result_of_run(const std::string& out, const std::string& program,
                          const std::string& hash, const ProcessBounds& bounds,
                          const ProcessEnd& end);

/// The result is that of the program as it would be run now: its hash is this one, its files are
/// there, and what was ended by a bound would meet the same bound. What has failed and lacks a file
/// is no result to keep: the disk may have been full.
bool still_holds(const BatchResult& result, const std::string& out, const std::string& hash,
                 const ProcessBounds& bounds);

}  // namespace kerf
