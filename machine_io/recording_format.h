// machine_io/recording_format.h - the text of kerf-recording/1 (README.md), for the recorder that
// writes it and the log source that reads it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "machine_io/position_source.h"
#include "machine_io/recorder.h"

namespace kerf {

inline constexpr std::string_view kRecordingMagic = "# kerf-recording/1";
inline constexpr std::string_view kRecordingLost = "# lost ";
inline constexpr std::string_view kRecordingSum = "# sum ";
inline constexpr std::string_view kRecordingClock = "# clock ";
inline constexpr std::string_view kRecordingRestarted = "# restarted";
inline constexpr std::string_view kRecordingEnd = "# end samples=";

/// "idle", "running", "paused"; "-" for kUnknown.
std::string_view program_state_text(ProgramState state);
/// And back; false if it is none of the four.
bool parse_program_state(std::string_view text, ProgramState& state);

/// Columns "x".."w", or "j0".."j8".
std::string_view position_column(CoordinateKind kind, std::size_t index);

/// "2026-03-01T09:30:00.000000123Z".
std::string iso_time(std::int64_t since_1970_ns);
/// And back; false if it is not such a text.
bool parse_iso_time(std::string_view text, std::int64_t& since_1970_ns);

/// CRC-32 (IEEE 802.3) of `bytes` behind bytes whose sum is `crc`; 0 begins.
std::uint32_t crc32(std::uint32_t crc, std::string_view bytes);
/// "# sum 1c291ca3" with its LF: of all lines since the last such line, or since the beginning,
/// each with a LF. The first one stands behind the header row.
std::string recording_sum_line(std::uint32_t crc);
/// And back; false if it is not such a line (without LF).
bool parse_recording_sum(std::string_view line, std::uint32_t& crc);

/// All head lines and the header row.
std::string recording_head_text(const RecordingHead& head);

/// One `# key: value` line of a head, taken into `head`. False if the line has no such shape or its
/// value is not one that the format allows; other keys go to `extra`.
bool read_recording_head_line(std::string_view line, RecordingHead& head);

/// Writes samples as lines. Remembers what it wrote, because an empty cell stands for that.
class RecordingLines {
 public:
  static constexpr std::size_t kLongestLine_bytes = 512;

  explicit RecordingLines(std::uint16_t axes, bool trigger = false, bool program = false,
                          bool load = false)
      : axes_(axes), trigger_(trigger), program_(program), load_(load) {}

  /// Puts the line with its LF at `out`, which has room for kLongestLine_bytes; returns its end.
  char* append(const AxisSample& sample, char* out);
  /// The next line stands for itself: what is before it may turn out to be damaged.
  void restart() { written_ = 0; }

 private:
  char* append_position(const AxisSample& sample, std::size_t index, char* out);

  std::uint16_t axes_;
  bool trigger_;
  bool program_;
  bool load_;
  std::uint16_t written_ = 0;  // bit i: last_[i] is what an empty cell would mean
  std::array<double, kMaxPositions> last_{};
};

}  // namespace kerf
