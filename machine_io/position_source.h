// machine_io/position_source.h - where live or logged positions come from. The only seam between a
// source (modbus/, can/, hal/, logs/) and the rest.
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "machine_io/spindle_load.h"

namespace kerf {

/// Joints 0..8, or axes X Y Z A B C U V W: which of the two, the configuration says.
inline constexpr std::size_t kMaxPositions = 9;

/// What a controller says of the program that it has.
enum class ProgramState : std::uint8_t {
  kUnknown,  ///< it does not say
  kIdle,     ///< none runs: it has ended or was aborted, or the machine is moved by hand or by MDI
  kRunning,
  kPaused,  ///< it stands in a program, which will go on
};

/// One reading of a machine. Positions in mm or degrees, after the source's scale and offset; where
/// they are (joints or axes, machine or workpiece frame) is not the source's business.
struct AxisSample {
  static constexpr std::int64_t kNoTime = std::numeric_limits<std::int64_t>::min();
  static constexpr std::int32_t kUnknown = -1;

  /// When this computer had it: CLOCK_REALTIME, ns. For logs: when that piece of the file was read;
  /// for recordings of kerf: as recorded, as if nobody had set that computer's clock meanwhile.
  std::int64_t host_ns = kNoTime;
  /// The device's own time, ns on a clock of its own: a log's stamps, the kernel's stamp of a
  /// frame, sample number times period. kNoTime if there is none. Never mixed with host_ns.
  std::int64_t device_ns = kNoTime;
  /// How old it was by host_ns when it was handed out, as far as the source knows: what came late
  /// is not called new. Not recorded: host_ns has it.
  std::int64_t age_ns = 0;
  std::array<double, kMaxPositions> position{};
  std::uint16_t known = 0;  ///< bit i: position[i] has been read at least once and is not too old
  std::uint16_t fresh = 0;  ///< bit i: position[i] was read for this sample
  std::int32_t tool = kUnknown;     ///< tool number in the spindle, 0 = none
  std::int32_t trigger = kUnknown;  ///< of a punch: 0 off, else on
  /// The controller has ended and begun again since the sample before: nothing of it ran meanwhile.
  bool restarted = false;
  std::int32_t line = kUnknown;  ///< program line that the machine says it is on; 0 = idle
  ProgramState program = ProgramState::kUnknown;
  double tool_offset_z_mm = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not given
  double spindle_rpm = std::numeric_limits<double>::quiet_NaN();       ///< signed; NaN: not given
  /// Of the spindle, as the machine itself tells it, in load_unit; NaN: not given.
  double load = std::numeric_limits<double>::quiet_NaN();
  LoadUnit load_unit = LoadUnit::kPercentOfPower;

  bool has(std::size_t index) const { return (known >> index & 1U) != 0; }
  void set(std::size_t index, double value) {
    position[index] = value;
    known = static_cast<std::uint16_t>(known | 1U << index);
    fresh = static_cast<std::uint16_t>(fresh | 1U << index);
  }
};

enum class SourceState : std::uint8_t {
  kConnecting,  ///< not there yet, or there again soon
  kReading,     ///< the last attempt gave data (how old it is, the reader of samples judges)
  kEnded,       ///< a log is at its end
  kFailed,      ///< cannot go on: the reason is in SourceStatus::trouble
};

/// What a source has been through. Counters only grow.
struct SourceStatus {
  SourceState state = SourceState::kConnecting;
  std::uint64_t samples = 0;
  std::uint64_t errors = 0;      ///< failed reads, damaged lines, frames that did not fit
  std::uint64_t reconnects = 0;  ///< after the first connection
  std::uint64_t lost = 0;        ///< data known to be lost: kernel queue overruns, gaps in counters
  std::uint64_t duplicates = 0;  ///< logs: the same stamp twice
  std::uint64_t incomplete = 0;  ///< cycles of a bus in which a frame was missing: dropped
  /// Logs: samples while the device's clock stood (LogSource::kStanding).
  std::uint64_t standing = 0;
  std::uint64_t damaged = 0;     ///< samples of a recording's parts whose sum is wrong: dropped
  std::uint64_t disordered = 0;  ///< stamps that went back; such samples are not handed out
  std::string trouble;  ///< the last thing that went wrong, for people; empty if nothing has
};

/// A source is asked by one thread of its own. It owns its connection and brings it back by itself.
/// It never writes to the machine: no Modbus write function, no CAN frame, no HAL pin but its own.
class PositionSource {
 public:
  enum class Next : std::uint8_t {
    kSample,   ///< `sample` is filled
    kNothing,  ///< `patience` has passed, or an attempt failed (status() tells); ask again
    kEnd,      ///< no more will come: kEnded or kFailed
  };

  virtual ~PositionSource() = default;

  /// Waits for the next sample for about `patience` (a poll that is under way may take its own
  /// timeout). Samples come in the order of their times, but for a clock that was set back.
  virtual Next next(AxisSample& sample, std::chrono::milliseconds patience) = 0;

  /// From the asking thread.
  virtual const SourceStatus& status() const = 0;

  /// "modbus tcp 192.168.1.7:502 unit 1", "can0", "run.csv": for messages and panels.
  virtual std::string describe() const = 0;
};

}  // namespace kerf
