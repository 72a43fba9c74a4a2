#include "machine_io/logs/candump_line.h"

#include "base/text_scan.h"
#include "base/translate.h"
#include "machine_io/logs/number_text.h"

namespace kerf {
namespace {

constexpr std::uint32_t kErrorFrameBit = 0x20000000;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::int64_t kLatestTime = 9'000'000'000 * kNsPerSecond;  // in the year 2255

int hex_value(char c) {
  if (is_digit(c)) return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Reads from left to right; `at` is where it stands and where a fault is.
struct Reader {
  std::string_view text;
  std::size_t at = 0;
  const char* fault = nullptr;

  bool fail(const char* why) {
    fault = why;
    return false;
  }
  char here() const { return at < text.size() ? text[at] : '\0'; }
  bool is_at_end_of_word() const { return at >= text.size() || is_blank(here()); }
  void skip_blanks() {
    while (is_blank(here())) ++at;
  }

  bool read_stamp(CandumpLine& line) {
    if (here() != '(') return fail(tr("'(' and the time in seconds are expected here"));
    const std::size_t close = text.find(')', at);
    if (close == std::string_view::npos) return fail(tr("the time has no ')'"));
    ++at;
    if (!parse_stamp(text.substr(at, close - at), kNsPerSecond, line.time_ns) || line.time_ns < 0 ||
        line.time_ns > kLatestTime) {
      return fail(tr("the time in seconds is expected here, as in (1795210989.363816)"));
    }
    at = close + 1;
    return true;
  }

  bool read_interface(CandumpLine& line) {
    skip_blanks();
    const std::size_t begin = at;
    while (!is_at_end_of_word()) ++at;
    line.interface = text.substr(begin, at - begin);
    if (line.interface.empty()) return fail(tr("the interface is expected here, as in can0"));
    skip_blanks();
    return true;
  }

  bool read_id(CanFrame& frame) {
    const std::size_t begin = at;
    std::uint32_t id = 0;
    for (; hex_value(here()) >= 0 && at - begin < 9; ++at) {
      id = id << 4U | static_cast<std::uint32_t>(hex_value(here()));
    }
    const std::size_t digits = at - begin;
    if (here() != '#' || (digits != 3 && digits != 8)) {
      at = begin;
      return fail(tr("3 or 8 hexadecimal digits and '#' are expected here, as in 381#3706"));
    }
    ++at;
    frame.error = digits == 8 && (id & kErrorFrameBit) != 0;
    frame.extended = digits == 8 && !frame.error;
    frame.id = id & kMaxExtendedCanId;
    const std::uint32_t most =
        digits == 3 ? kMaxStandardCanId : kMaxExtendedCanId | (frame.error ? kErrorFrameBit : 0U);
    if (id > most) {
      at = begin;
      return fail(tr("the identifier is too large: 7FF is the last of 3 digits, 1FFFFFFF of 8"));
    }
    return true;
  }

  bool read_data(CanFrame& frame) {
    const std::size_t most = frame.fd ? 64 : 8;
    while (!is_at_end_of_word()) {
      if (here() == '.' && frame.length > 0) ++at;
      if (here() == '_' && !frame.fd && frame.length == 8) break;
      const int high = hex_value(here());
      const int low = at + 1 < text.size() ? hex_value(text[at + 1]) : -1;
      if (high < 0 || low < 0) return fail(tr("two hexadecimal digits per byte are expected here"));
      if (frame.length == most) return fail(tr("more bytes than a frame holds"));
      frame.data[frame.length++] = static_cast<std::uint8_t>(high << 4 | low);
      at += 2;
    }
    if (here() == '_') {
      ++at;
      if (hex_value(here()) < 9) return fail(tr("a length code of 9 to F is expected behind '_'"));
      ++at;
    }
    return is_at_end_of_word() || fail(tr("the frame does not end here as it should"));
  }

  bool read_remote(CanFrame& frame) {
    ++at;
    frame.remote = true;
    if (here() >= '0' && here() <= '8') ++at;
    if (here() == '_') at += 2;
    return is_at_end_of_word() || fail(tr("a length of 0 to 8 is expected behind R"));
  }

  bool read_frame(CanFrame& frame) {
    if (!read_id(frame)) return false;
    if (here() == '#') {
      ++at;
      if (hex_value(here()) < 0)
        return fail(tr("the flags of CAN FD are expected here: one digit"));
      ++at;
      frame.fd = true;
    } else if (here() == 'R' || here() == 'r') {
      return read_remote(frame);
    }
    return read_data(frame);
  }
};

}  // namespace

bool read_candump_line(std::string_view text, CandumpLine& line, CandumpFault& fault) {
  line.frame = CanFrame{};
  Reader reader{text};
  reader.skip_blanks();
  if (reader.read_stamp(line) && reader.read_interface(line) && reader.read_frame(line.frame)) {
    return true;
  }
  fault.column = static_cast<int>(reader.at) + 1;
  fault.text = reader.fault;
  return false;
}

}  // namespace kerf
