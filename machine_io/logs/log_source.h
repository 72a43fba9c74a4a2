// machine_io/logs/log_source.h - positions from a file or a pipe: recordings of kerf, CSV,
// LinuxCNC's halsampler, candump.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "machine_io/can/can_map.h"
#include "machine_io/position_source.h"
#include "machine_io/recorder.h"

namespace kerf {

enum class LogFormat : std::uint8_t {
  kAuto,        ///< by the first lines; halsampler when `pins` are given
  kRecording,   ///< kerf-recording/1 (machine_io/README.md)
  kCsv,         ///< a header row that names the columns
  kHalsampler,  ///< numbers between spaces, no header: `pins` names the columns
  kCandump,     ///< candump -l or -L; `can_map` says what the frames mean
};

enum class LogUnit : std::uint8_t { kMm, kInch };

/// The column that is the spindle's load, where its name does not say so: value * scale + offset.
struct LogLoad {
  std::string column;
  LoadUnit unit = LoadUnit::kPercentOfPower;
  double scale = 1, offset = 0;
};

struct LogSettings {
  std::string path;  ///< "-": standard input
  LogFormat format = LogFormat::kAuto;

  /// halsampler: the HAL pins in the order of the columns, the sample number of `-t` not counted.
  /// Pins without a part in AxisSample are ignored and listed in notes(). pins_from_hal_file()
  /// reads them from the .hal file that set the sampler up.
  std::vector<std::string> pins;
  /// halsampler: seconds from one sample number to the next, the period of the sampler's thread.
  /// 1e-6 to 10.
  double period_s = 0.001;

  /// csv, halsampler: of lengths whose column does not say its unit.
  LogUnit unit = LogUnit::kMm;
  /// Bit i: joint i counts degrees, so `unit` is not for it. The axes A, B and C never are lengths.
  std::uint16_t rotary_joints = 0;

  /// csv, halsampler: a column, or a pin.
  std::optional<LogLoad> load;

  /// candump: which bits of which frame are which position. Not looked at otherwise.
  std::optional<CanMap> can_map;
  /// candump: frames of this interface alone ("can0"); empty: of all that are in the log.
  std::string can_interface;
};

/// All faults that need no look at the file, one text each:
/// "source.period_s: 0 found, 0.000001 to 10 allowed (seconds per sample)".
std::vector<std::string> validate(const LogSettings& settings);

/// HAL pins of the columns of sampler channel `channel`, read from a .hal file: `net`, `linksp`,
/// `linkps` and `loadrt sampler cfg=..` in any of HAL's shapes (arrows are decoration to it, a
/// signal may be named on several lines, `\` continues a line). A column whose signal has no other
/// pin in this file is named "signal NAME", one that is connected to nothing is "". Empty list, and
/// diagnostics say why: no such file, no sampler in it, a pin beyond `cfg`.
std::vector<std::string> pins_from_hal_file(const std::string& path, int channel,
                                            Diagnostics& diagnostics);
/// The same from text; `name` is for messages.
std::vector<std::string> pins_from_hal_text(std::string_view text, const std::string& name,
                                            int channel, Diagnostics& diagnostics);

/// What a log holds, as far as its first lines tell.
struct LogContents {
  LogFormat format = LogFormat::kCsv;  ///< never kAuto
  std::uint16_t positions = 0;         ///< bit i: there is a column for position[i]
  /// Joints or axes by the names of the columns; empty where names do not tell (candump).
  std::optional<CoordinateKind> kind;
  std::optional<LoadUnit> load;  ///< there is a column for it
  /// The head of a recording; nothing in other formats.
  std::optional<RecordingHead> recording;
};

/// Reads a log as fast as asked (the pace is the asker's business), one pass, 256 kB at a time.
///
/// CSV: a header row, then cells between ',', ';' or tabs, which may be quoted as in RFC 4180 (but
/// not hold line ends); `#` begins a comment; LF or CRLF. Columns, in any order and case: t (time,
/// timestamp, t_device, t_host; one is needed), x .. w or j0 .. j8 (joint0, or LinuxCNC's HAL pins;
/// at least one), tool, line, tool_offset_z (tloz), spindle_rpm (rpm), trigger, program,
/// load_percent, load_percent_torque, load_kw, load_nm, load_a. A unit may be in the name: x_mm, "x
/// [in]", x(mm), t_ms, t_ns. Others are ignored and listed in notes(). Cells that are empty and '-'
/// mean what they mean in a recording.
///
/// Times: a recording has both its times back as recorded, to the ns (but see below). Of other logs
/// device_ns is the log's stamp (seconds of whatever clock it has; halsampler: sample number times
/// period, from 0) and host_ns is when this computer read the piece of the file.
///
/// What becomes of lines:
///   comment, blank                  passed over
///   not readable as the format says errors + 1; the first kMostDescribed of them are in notes()
///   stamp equal to the last one     the same once more: duplicates + 1. Another position, or
///                                   received later: the device's clock stands. It is handed out,
///                                   its device_ns later by what passed between the times of
///                                   receipt (of a recording, or from a pipe; other files have
///                                   none), and so are those behind it. From the kStanding-th in a
///                                   row on they are counted in standing, with a note
///   stamp before the last one       disordered + 1. After kClockSet such lines that are in order
///                                   among themselves, the log's clock is taken as set back: a
///                                   note, and reading goes on with the next one
///   `# lost N`, `overrun`, a gap in
///   halsampler's numbers            lost + N; one `overrun` without numbers counts 1
///   recordings: a part whose sum
///   is wrong                        errors + 1, and its samples are damaged + 1 and lost + 1 each
///   last line without a line end    recording: dropped, `trouble` says "cut off after N samples"
///                                   (a number may have lost digits). Other formats: read as it is
/// Allocates nothing per line. Above 1 million lines of 12 columns per second.
class LogSource final : public PositionSource {
 public:
  static constexpr std::size_t kMostDescribed = 20;
  static constexpr int kClockSet = 10;
  static constexpr int kStanding = 10;
  /// Longer lines are damaged: no log has such.
  static constexpr std::size_t kLongestLine_bytes = std::size_t{1} << 20U;

  /// Opens and reads as far as the first sample's line; a pipe is waited for. Null: `diagnostics`
  /// has errors, with file:line:column where there is one.
  static std::unique_ptr<LogSource> open(LogSettings settings, Diagnostics& diagnostics);
  ~LogSource() override;

  /// Files never wait; a pipe is waited for up to `patience`. A read error is kFailed.
  Next next(AxisSample& sample, std::chrono::milliseconds patience) override;
  const SourceStatus& status() const override;
  std::string describe() const override;

  const LogContents& contents() const;
  /// For people: columns that are ignored, damaged lines, a clock that was set. Grows while
  /// reading, up to a small limit.
  const Diagnostics& notes() const;

 private:
  class Reading;
  explicit LogSource(std::unique_ptr<Reading> reading);
  std::unique_ptr<Reading> reading_;
};

}  // namespace kerf
