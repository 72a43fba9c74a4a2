// machine_io/logs/line_reader.h - a file or pipe, line by line, in large blocks.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// One pass, forward. Holds one block; grows for lines that are longer, up to `longest_line`.
class LineReader {
 public:
  enum class Got : std::uint8_t {
    kLine,     ///< without its LF, and without a CR before that
    kUnended,  ///< the last line, which has no LF
    kTooLong,  ///< a line above the limit was passed over; `line` is its first piece
    kNothing,  ///< a pipe: nothing more within the patience
    kEnd,      ///< as often as asked
    kFault,    ///< reading failed: fault()
  };

  static constexpr std::size_t kBlock_bytes = std::size_t{256} << 10U;

  /// Takes the descriptor over. `is_waited_for`: a pipe or terminal, where data may come later.
  LineReader(int fd, bool is_waited_for, std::size_t longest_line);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// `line` is valid until the next call. A negative patience waits as long as it takes.
  Got next(std::string_view& line, std::chrono::milliseconds patience);

  /// Of the line handed out last, from 1.
  std::uint64_t line_number() const { return line_number_; }
  /// CLOCK_REALTIME when the block with the last line's end was read.
  std::int64_t read_ns() const { return read_ns_; }
  const std::string& fault() const { return fault_; }

 private:
  enum class Fill : std::uint8_t { kMore, kNothing, kEnd, kFault };
  Fill fill(std::chrono::milliseconds patience);
  bool make_room();

  int fd_;
  bool is_waited_for_;
  std::size_t longest_line_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;    // of the line that is next
  std::size_t scanned_ = 0;  // up to here there is no LF
  std::size_t end_ = 0;
  bool is_skipping_ = false;  // in a line above the limit
  bool is_ended_ = false;
  std::uint64_t line_number_ = 0;
  std::int64_t read_ns_ = 0;
  std::string fault_;
};

}  // namespace kerf
