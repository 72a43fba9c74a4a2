// twin/batch/result_log.h - results.jsonl: a line for each program that has ended.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "twin/batch/batch_result.h"

namespace kerf {

/// The results of a text that may be cut off at any byte, or be damaged anywhere: of each program
/// the last whole line, in the order of their first ones. `damaged`: something else is there, too.
std::vector<BatchResult> parse_results(std::string_view text, bool& damaged);

/// Adds lines to the file, each whole or not at all: what a full disk has taken of a line is cut
/// off again. Synced, so that it is there after a power cut.
class ResultLog {
 public:
  /// Begins with these results. The file is made anew if it does not hold `as_it_is` already.
  static Result<ResultLog> open(const std::string& path, const std::vector<BatchResult>& results,
                                bool as_it_is);
  ResultLog(ResultLog&& other) noexcept;
  ResultLog& operator=(ResultLog&&) = delete;
  ~ResultLog();
  Done append(const BatchResult& result);

 private:
  ResultLog(std::string path, int fd) : path_(std::move(path)), fd_(fd) {}
  std::string path_;
  int fd_ = -1;
};

}  // namespace kerf
