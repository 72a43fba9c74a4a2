// interp_bridge/kerf_interp/record_writer.h - records to a pipe, buffered.
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "interp_bridge/record_format.h"

namespace kerf::interp {

/// Writes whole records. What waits in the buffer goes out when it is full or flush() is called. A
/// reader that is gone ends this process (SIGPIPE).
class RecordWriter {
 public:
  explicit RecordWriter(int fd) : fd_(fd), buffer_(kBufferBytes) {
    std::memcpy(room(sizeof records::kMagic), records::kMagic, sizeof records::kMagic);
  }

  /// `level` of the records that follow.
  void set_level(int level) {
    level_ = static_cast<std::uint8_t>(level < 0 ? 0 : level > 255 ? 255 : level);
  }

  void numbers(std::uint8_t code, int line, const double* values, std::size_t count) {
    char* out = begin(code, line, count, 8 * count);
    if (count > 0) std::memcpy(out, values, 8 * count);
  }
  void numbers(std::uint8_t code, int line, std::initializer_list<double> values) {
    numbers(code, line, values.begin(), values.size());
  }
  void text(std::uint8_t code, int line, std::string_view text) {
    text = text.substr(0, records::kMaxText);
    const std::size_t bytes = (text.size() + 7) / 8 * 8;
    char* out = begin(code, line, text.size(), bytes);
    std::memset(out, 0, bytes);
    if (!text.empty()) std::memcpy(out, text.data(), text.size());
  }

  bool empty() const { return used_ == 0; }
  /// While it is on, what a machine would do is left out; what only sets how it would is written.
  void leave_out_deeds(bool on) { leaves_out_deeds_ = on; }
  void flush();

 private:
  static constexpr std::size_t kBufferBytes = 64 * 1024;
  char* begin(std::uint8_t code, int line, std::size_t count, std::size_t payload) {
    if (leaves_out_deeds_ && is_deed(code)) {
      left_out_.resize(payload);
      return left_out_.data();
    }
    char* out = room(sizeof(records::Head) + payload);
    const records::Head head{code, level_, static_cast<std::uint16_t>(count),
                             line > 0 ? static_cast<std::uint32_t>(line) : 0U};
    std::memcpy(out, &head, sizeof head);
    return out + sizeof head;
  }
  static bool is_deed(std::uint8_t code);
  char* room(std::size_t bytes) {
    if (used_ + bytes > buffer_.size()) make_room(bytes);
    char* out = buffer_.data() + used_;
    used_ += bytes;
    return out;
  }
  void make_room(std::size_t bytes);

  int fd_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
  std::uint8_t level_ = 0;
  bool leaves_out_deeds_ = false;
  std::vector<char> left_out_;  ///< where such a record goes
};

}  // namespace kerf::interp
