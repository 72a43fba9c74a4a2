// machine_io/logs/log_opening.h - the first lines of a log: which format it has and what its
// columns are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "machine_io/logs/line_reader.h"
#include "machine_io/logs/log_lines.h"

namespace kerf {

/// A log whose first lines have been read.
struct OpenedLog {
  LogContents contents;
  std::unique_ptr<LogLines> lines;
  /// A line of samples that had to be looked at already: to be read first. Its number is the
  /// reader's.
  std::string first_line;
  bool has_first_line = false;
  bool is_first_unended = false;
  std::uint32_t sum = 0;  ///< crc32() of the lines since the last sum, each with a LF
};

/// Reads as far as needed. False: `diagnostics` has errors. What is ignored goes to `notes`.
/// `name` is the file's, for messages.
bool open_log(LineReader& reader, const std::string& name, const LogSettings& settings,
              OpenedLog& log, Diagnostics& notes, Diagnostics& diagnostics);

}  // namespace kerf
