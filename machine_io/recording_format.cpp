#include "machine_io/recording_format.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "base/text_scan.h"

namespace kerf {
namespace {

constexpr std::string_view kSumName = "crc32";

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

// Room for any double or integer: -1.7976931348623157e+308 is 24 long.
constexpr std::size_t kLongestNumber = 32;

template <class Number>
char* append_number(Number number, char* out) {
  return std::to_chars(out, out + kLongestNumber, number).ptr;
}

char* append_stamp(std::int64_t time_ns, char* out) {
  if (time_ns == AxisSample::kNoTime) return out;
  std::uint64_t magnitude = static_cast<std::uint64_t>(time_ns);
  if (time_ns < 0) {
    *out++ = '-';
    magnitude = ~magnitude + 1U;
  }
  out = append_number(magnitude / kNsPerSecond, out);
  *out++ = '.';
  std::uint64_t rest = magnitude % kNsPerSecond;
  for (std::ptrdiff_t digit = 8; digit >= 0; --digit, rest /= 10) {
    out[digit] = static_cast<char>('0' + rest % 10);
  }
  return out + 9;
}

char* append_known(double number, char* out) {
  if (std::isfinite(number)) return append_number(number, out);
  *out++ = '-';
  return out;
}

char* append_known(std::int32_t number, char* out) {
  if (number >= 0) return append_number(number, out);
  *out++ = '-';
  return out;
}

std::string on_one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
  }
  return text;
}

/// `digits` decimal digits at `at`, which is moved behind them.
bool take_digits(std::string_view text, std::size_t& at, std::size_t digits, int& value) {
  if (text.size() - at < digits) return false;
  value = 0;
  for (std::size_t end = at + digits; at < end; ++at) {
    if (text[at] < '0' || text[at] > '9') return false;
    value = value * 10 + (text[at] - '0');
  }
  return true;
}

bool read_coordinates(std::string_view value, RecordingHead& head) {
  const std::size_t space = value.find(' ');
  if (space == std::string_view::npos) return false;
  const std::string_view kind = value.substr(0, space);
  const std::string_view frame = value.substr(space + 1);
  if (kind != "joints" && kind != "axes") return false;
  if (frame != "machine" && frame != "workpiece") return false;
  head.kind = kind == "joints" ? CoordinateKind::kJoints : CoordinateKind::kAxes;
  head.frame = frame == "machine" ? CoordinateFrame::kMachine : CoordinateFrame::kWorkpiece;
  return true;
}

}  // namespace

std::string_view position_column(CoordinateKind kind, std::size_t index) {
  static constexpr std::array<std::string_view, kMaxPositions> kJoints{"j0", "j1", "j2", "j3", "j4",
                                                                       "j5", "j6", "j7", "j8"};
  static constexpr std::array<std::string_view, kMaxPositions> kAxes{"x", "y", "z", "a", "b",
                                                                     "c", "u", "v", "w"};
  return kind == CoordinateKind::kJoints ? kJoints[index] : kAxes[index];
}

std::uint32_t crc32(std::uint32_t crc, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(crc, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

std::string recording_sum_line(std::uint32_t crc) {
  return fmt::format("{}{:08x}\n", kRecordingSum, crc);
}

bool parse_recording_sum(std::string_view line, std::uint32_t& crc) {
  if (!line.starts_with(kRecordingSum)) return false;
  line.remove_prefix(kRecordingSum.size());
  return read_number(line, crc, 16) && line.size() == 8;
}

std::string iso_time(std::int64_t since_1970_ns) {
  using namespace std::chrono;
  const sys_time<nanoseconds> time{nanoseconds{since_1970_ns}};
  const auto day = floor<days>(time);
  const year_month_day date{day};
  const hh_mm_ss clock{time - day};
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:09}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     clock.hours().count(), clock.minutes().count(), clock.seconds().count(),
                     clock.subseconds().count());
}

bool parse_iso_time(std::string_view text, std::int64_t& since_1970_ns) {
  // Digits and what stands between them.
  static constexpr std::array<std::size_t, 7> kDigits{4, 2, 2, 2, 2, 2, 9};
  static constexpr std::string_view kBetween = "--T::.Z";
  std::array<int, 7> part{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (!take_digits(text, at, kDigits[i], part[i])) return false;
    if (at == text.size() || text[at++] != kBetween[i]) return false;
  }
  using namespace std::chrono;
  const year_month_day date{year{part[0]}, month{static_cast<unsigned>(part[1])},
                            day{static_cast<unsigned>(part[2])}};
  // 1678 to 2261 is what 64 bits of ns hold.
  if (at != text.size() || !date.ok() || part[0] < 1678 || part[0] > 2261) return false;
  if (part[3] > 23 || part[4] > 59 || part[5] > 59) return false;
  const seconds whole =
      sys_days{date}.time_since_epoch() + hours{part[3]} + minutes{part[4]} + seconds{part[5]};
  since_1970_ns = whole.count() * kNsPerSecond + part[6];
  return true;
}

std::string_view program_state_text(ProgramState state) {
  switch (state) {
    case ProgramState::kIdle:
      return "idle";
    case ProgramState::kRunning:
      return "running";
    case ProgramState::kPaused:
      return "paused";
    case ProgramState::kUnknown:
      break;
  }
  return "-";
}

bool parse_program_state(std::string_view text, ProgramState& state) {
  for (const ProgramState one : {ProgramState::kUnknown, ProgramState::kIdle,
                                 ProgramState::kRunning, ProgramState::kPaused}) {
    if (text != program_state_text(one)) continue;
    state = one;
    return true;
  }
  return false;
}

std::string recording_head_text(const RecordingHead& head) {
  std::string text = fmt::format("{}\n", kRecordingMagic);
  text += fmt::format("# source: {}\n", on_one_line(head.source));
  text += "# units: mm\n";
  text += fmt::format("# coordinates: {} {}\n",
                      head.kind == CoordinateKind::kJoints ? "joints" : "axes",
                      head.frame == CoordinateFrame::kMachine ? "machine" : "workpiece");
  text += fmt::format("# start: {}\n", iso_time(head.start_ns));
  if (head.sums) text += fmt::format("# sums: {}\n", kSumName);
  for (const auto& [key, value] : head.extra) {
    text += fmt::format("# {}: {}\n", key, on_one_line(value));
  }
  text += "t_host,t_device";
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if ((head.axes >> i & 1U) != 0) text += fmt::format(",{}", position_column(head.kind, i));
  }
  text += ",tool,line,tool_offset_z,spindle_rpm";
  if (head.trigger) text += ",trigger";
  if (head.program) text += ",program";
  if (head.load) text += fmt::format(",{}", column_of(*head.load));
  text += '\n';
  return text;
}

bool read_recording_head_line(std::string_view line, RecordingHead& head) {
  if (!line.starts_with("# ")) return false;
  line.remove_prefix(2);
  const std::size_t colon = line.find(": ");
  if (colon == std::string_view::npos || colon == 0) return false;
  const std::string_view key = line.substr(0, colon);
  const std::string_view value = line.substr(colon + 2);
  if (key == "source") {
    head.source = value;
  } else if (key == "units") {
    return value == "mm";
  } else if (key == "coordinates") {
    return read_coordinates(value, head);
  } else if (key == "sums" && value == kSumName) {
    head.sums = true;
  } else if (key == "start") {
    return parse_iso_time(value, head.start_ns);
  } else {
    head.extra.emplace_back(key, value);
  }
  return true;
}

char* RecordingLines::append_position(const AxisSample& sample, std::size_t index, char* out) {
  const double value = sample.position[index];
  const auto bit = static_cast<std::uint16_t>(1U << index);
  if (!sample.has(index) || !std::isfinite(value)) {
    written_ = static_cast<std::uint16_t>(written_ & ~bit);
    *out++ = '-';
    return out;
  }
  if ((sample.fresh & bit) == 0) {
    // Compared as bits: -0.0 is another value than 0.0 for a replay.
    const bool is_last = (written_ & bit) != 0 && std::bit_cast<std::uint64_t>(value) ==
                                                      std::bit_cast<std::uint64_t>(last_[index]);
    if (is_last) return out;
    *out++ = '~';
  }
  written_ = static_cast<std::uint16_t>(written_ | bit);
  last_[index] = value;
  return append_number(value, out);
}

char* RecordingLines::append(const AxisSample& sample, char* out) {
  out = append_stamp(sample.host_ns, out);
  *out++ = ',';
  out = append_stamp(sample.device_ns, out);
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if ((axes_ >> i & 1U) == 0) continue;
    *out++ = ',';
    out = append_position(sample, i, out);
  }
  *out++ = ',';
  out = append_known(sample.tool, out);
  *out++ = ',';
  out = append_known(sample.line, out);
  *out++ = ',';
  out = append_known(sample.tool_offset_z_mm, out);
  *out++ = ',';
  out = append_known(sample.spindle_rpm, out);
  if (trigger_) {
    *out++ = ',';
    out = append_known(sample.trigger, out);
  }
  if (program_) {
    *out++ = ',';
    const std::string_view state = program_state_text(sample.program);
    out = std::copy(state.begin(), state.end(), out);
  }
  if (load_) {
    *out++ = ',';
    out = append_known(sample.load, out);
  }
  *out++ = '\n';
  return out;
}

}  // namespace kerf
