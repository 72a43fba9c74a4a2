#include "machine_io/logs/line_reader.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

namespace kerf {

LineReader::LineReader(int fd, bool is_waited_for, std::size_t longest_line)
    : fd_(fd), is_waited_for_(is_waited_for), longest_line_(longest_line), buffer_(kBlock_bytes) {}

LineReader::~LineReader() { ::close(fd_); }

/// False: the line is at its limit and there is no room for more of it.
bool LineReader::make_room() {
  if (begin_ > 0) {
    // A piece of a line, as a rule: the reads stay large.
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    scanned_ -= begin_;
    begin_ = 0;
  }
  if (end_ < buffer_.size()) return true;
  if (buffer_.size() >= longest_line_) return false;
  buffer_.resize(std::min(buffer_.size() * 2, longest_line_));
  return true;
}

LineReader::Fill LineReader::fill(std::chrono::milliseconds patience) {
  if (is_ended_) return Fill::kEnd;
  while (true) {
    if (is_waited_for_) {
      pollfd wait{fd_, POLLIN, 0};
      const auto limit = std::min<std::int64_t>(patience.count(), std::numeric_limits<int>::max());
      const int ready = ::poll(&wait, 1, limit < 0 ? -1 : static_cast<int>(limit));
      // A signal may mean that the asker has to end: let it look.
      if (ready == 0 || (ready < 0 && errno == EINTR && limit >= 0)) return Fill::kNothing;
    }
    const ssize_t n = ::read(fd_, buffer_.data() + end_, buffer_.size() - end_);
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (n < 0) {
      char text[128];
      fault_ = strerror_r(errno, text, sizeof text);
      is_ended_ = true;
      return Fill::kFault;
    }
    if (n == 0) {
      is_ended_ = true;
      return Fill::kEnd;
    }
    end_ += static_cast<std::size_t>(n);
    read_ns_ = std::chrono::duration_cast<std::chrono::nanoseconds>(
                   std::chrono::system_clock::now().time_since_epoch())
                   .count();
    return Fill::kMore;
  }
}

LineReader::Got LineReader::next(std::string_view& line, std::chrono::milliseconds patience) {
  while (true) {
    const auto* newline = static_cast<const char*>(
        scanned_ == end_ ? nullptr : std::memchr(buffer_.data() + scanned_, '\n', end_ - scanned_));
    if (newline != nullptr) {
      const auto at = static_cast<std::size_t>(newline - buffer_.data());
      line = std::string_view(buffer_.data() + begin_, at - begin_);
      if (line.ends_with('\r')) line.remove_suffix(1);
      begin_ = scanned_ = at + 1;
      if (!std::exchange(is_skipping_, false)) return ++line_number_, Got::kLine;
      continue;
    }
    scanned_ = end_;
    if (is_skipping_) begin_ = scanned_ = end_ = 0;
    if (!make_room()) {
      line = std::string_view(buffer_.data() + begin_, end_ - begin_);
      is_skipping_ = true;
      return ++line_number_, Got::kTooLong;
    }
    switch (fill(patience)) {
      case Fill::kMore:
        break;
      case Fill::kNothing:
        return Got::kNothing;
      case Fill::kFault:
        return Got::kFault;
      case Fill::kEnd:
        if (begin_ == end_ || is_skipping_) return fault_.empty() ? Got::kEnd : Got::kFault;
        line = std::string_view(buffer_.data() + begin_, end_ - begin_);
        if (line.ends_with('\r')) line.remove_suffix(1);
        begin_ = scanned_ = end_;
        return ++line_number_, Got::kUnended;
    }
  }
}

}  // namespace kerf
