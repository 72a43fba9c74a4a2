// machine_io/hal/hal_stream.h - what kerf-hal and kerf say to each other: two fixed records.
// README.md beside it has the same as a table, and what the pins mean.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include "machine_io/hal/hal_messages.h"

namespace kerf {

/// Both ends run on one computer, so nothing is converted; the format is little-endian all the
/// same, as every PC that LinuxCNC runs on.
static_assert(std::endian::native == std::endian::little);

/// Raised with every change of a record. Ends of different versions refuse each other.
inline constexpr std::uint16_t kHalStreamVersion = 3;
inline constexpr std::uint32_t kHalSampleMagic = 0x534C484B;  ///< "KHLS" in the stream
inline constexpr std::uint32_t kHalStatusMagic = 0x504C484B;  ///< "KHLP" in the stream

/// Joints 0..8 and the letters X Y Z A B C U V W.
inline constexpr std::size_t kHalAxes = 9;

inline constexpr double kHalAbsent = std::numeric_limits<double>::quiet_NaN();

/// Bits of HalSampleRecord::known and ::on. A bit of `on` has a meaning only if the same bit of
/// `known` is set, that is: if the pin existed.
enum HalBit : std::uint32_t {
  kHalInPosition = 1U << 0,      ///< motion.in-position
  kHalProgramRunning = 1U << 1,  ///< halui.program.is-running
  kHalProgramPaused = 1U << 2,   ///< halui.program.is-paused
  kHalProgramIdle = 1U << 3,     ///< halui.program.is-idle
  kHalToolNumber = 1U << 4,      ///< `known` only: tool_number has been read
  kHalProgramLine = 1U << 5,     ///< `known` only: program_line has been read
  /// `on`: the kerf.* pins are another component's; what kerf says is not shown. Always known.
  kHalPinsTaken = 1U << 6,
  kHalModeAuto = 1U << 7,  ///< halui.mode.is-auto
};

/// One reading of the running LinuxCNC, from kerf-hal's stdout. All values are as the pins have
/// them: machine units (mm or inch as the INI's LINEAR_UNITS says; HAL does not tell which) and
/// degrees. A value whose pin does not exist is NaN.
struct HalSampleRecord {
  std::uint32_t magic = kHalSampleMagic;
  std::uint16_t version = kHalStreamVersion;
  std::uint16_t bytes = 0;        ///< sizeof(HalSampleRecord)
  std::uint64_t sequence = 0;     ///< 0, 1, ..; a gap: readings that could not be handed on in time
  std::int64_t realtime_ns = 0;   ///< CLOCK_REALTIME of the reading
  std::int64_t monotonic_ns = 0;  ///< CLOCK_MONOTONIC of the reading: never set back
  std::array<double, kHalAxes> joint{};        ///< joint.N.pos-fb: machine coordinates
  std::array<double, kHalAxes> axis_offset{};  ///< axis.L.eoffset: external offset, part of joint[]
  std::array<double, kHalAxes> tool_offset{};  ///< motion.tooloffset.x .. w
  double spindle_rpm = kHalAbsent;             ///< spindle.0.speed-out, signed
  double velocity = kHalAbsent;                ///< motion.current-vel, units/s
  double load = kHalAbsent;                    ///< the pin of kerf-hal --load
  std::int32_t program_line = 0;               ///< motion.program-line, 0 = nothing moves
  std::int32_t tool_number = 0;                ///< iocontrol.0.tool-number, 0 = none
  std::uint32_t joint_count = 0;  ///< joints that LinuxCNC has (the first nine are read)
  std::uint32_t known = 0;        ///< HalBit
  std::uint32_t on = 0;           ///< HalBit
  std::uint32_t unused = 0;       ///< 0
};
static_assert(sizeof(HalSampleRecord) == 296 && std::is_trivially_copyable_v<HalSampleRecord>);
static_assert(offsetof(HalSampleRecord, joint) == 32);
static_assert(offsetof(HalSampleRecord, spindle_rpm) == 248);
static_assert(offsetof(HalSampleRecord, program_line) == 272);

/// kerf.collision-seconds while no collision is in sight: a plain large number, because a NaN or
/// an infinity spreads through HAL components that calculate with it.
inline constexpr double kNoCollisionSeconds = 1e6;

/// Without a status for this long kerf-hal sets kerf.stale and clears kerf.alive.
inline constexpr std::int64_t kHalStatusTimeout_ns = 1'000'000'000;

/// What the kerf.* pins are to show. One with each sending; each raises kerf.heartbeat by one.
struct HalStatus {
  double collision_seconds = kNoCollisionSeconds;  ///< until the announced collision; >= 0
  double off_path_mm = 0.0;                        ///< distance of the tip from the programmed path
  std::int32_t finding_line = 0;  ///< program line of the announced collision, 0 = none
  bool collision_ahead = false;
  bool off_path = false;
  bool stale = false;  ///< kerf itself has no current positions, or cannot tell
  /// The program that LinuxCNC has loaded, as it is on the disk, was run through, without errors.
  bool program_ok = false;
  std::int32_t findings = -1;  ///< errors and warnings of it; -1: not known (yet)
  double time_left_s = -1.0;   ///< that it takes from where it is, >= 0; -1: not known
};

/// HalStatus on its way, to kerf-hal's stdin.
struct HalStatusRecord {
  std::uint32_t magic = kHalStatusMagic;
  std::uint16_t version = kHalStreamVersion;
  std::uint16_t bytes = 0;  ///< sizeof(HalStatusRecord)
  double collision_seconds = kNoCollisionSeconds;
  double off_path_mm = 0.0;
  std::int32_t finding_line = 0;
  std::uint8_t collision_ahead = 0;  ///< these four: 0 or 1
  std::uint8_t off_path = 0;
  std::uint8_t stale = 0;
  std::uint8_t program_ok = 0;
  std::int32_t findings = -1;
  std::uint32_t unused = 0;  ///< 0
  double time_left_s = -1.0;
};
static_assert(sizeof(HalStatusRecord) == 48 && std::is_trivially_copyable_v<HalStatusRecord>);

/// Why a record's head is not one of this version; nothing if it is.
template <class Record>
std::optional<HalMessage> head_fault(const Record& record) {
  if (record.magic != Record{}.magic) return HalMessage::kNoRecord;
  if (record.version != kHalStreamVersion) return HalMessage::kOtherVersion;
  if (record.bytes != sizeof(Record)) return HalMessage::kOtherLength;
  return std::nullopt;
}

/// Exit statuses of kerf-hal.
inline constexpr int kHalExitAsked = 0;       ///< SIGTERM, SIGINT, or nobody reads its stdout
inline constexpr int kHalExitTrouble = 1;     ///< HAL refused; stderr says what
inline constexpr int kHalExitUsage = 2;       ///< wrong command line
inline constexpr int kHalExitNoLinuxCnc = 4;  ///< none runs, or it has gone

}  // namespace kerf
