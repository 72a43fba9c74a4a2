// machine_io/hal/hal_source.h - positions of the LinuxCNC that runs on this computer, from HAL.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "machine_io/hal/hal_stream.h"
#include "machine_io/position_source.h"

namespace kerf {

/// Which pin is the spindle's load, and what its number is of it: value * scale + offset.
struct HalLoad {
  std::string pin;
  LoadUnit unit = LoadUnit::kPercentOfPower;
  double scale = 1, offset = 0;
};

/// No map is needed: the pins have the same names in every LinuxCNC (README.md lists them).
struct HalSettings {
  static constexpr double kLowestRate_hz = 1.0;
  static constexpr double kHighestRate_hz = 1000.0;

  double rate_hz = 100.0;     ///< readings per second, 1 to 1000
  std::string kerf_hal_path;  ///< empty: beside this executable, in ../lib/kerf, or in PATH
  /// One of LinuxCNC's linear units: 1 if the INI says LINEAR_UNITS = mm, 25.4 if inch. HAL does
  /// not tell which.
  double mm_per_unit = 1.0;
  /// Bit i: joint i counts degrees, so mm_per_unit is not for it.
  std::uint16_t rotary_joints = 0;
  std::optional<HalLoad> load;
};

/// All faults, one text each: "source.rate_hz: 0 found, 1 to 1000 allowed (readings per second)".
std::vector<std::string> validate(const HalSettings& settings);

/// A program of LinuxCNC's side that belongs to kerf: beside this executable, in ../lib/kerf beside
/// it, or in PATH; empty if there is none.
std::string find_hal_program(const std::string& name);

/// The executable that `given` (HalSettings::kerf_hal_path) means; empty if there is none.
std::string find_kerf_hal(const std::string& given);

/// Starts kerf-hal and reads its records. LinuxCNC's end also ends kerf-hal, as every component of
/// HAL; it is started again after 0.5 s, 1 s, .. 5 s, until LinuxCNC is back.
///
/// A sample has joints (joint.N.pos-fb, machine coordinates: motor offsets and compensation are
/// out, work offsets and tool length are in), tool, line, tool_offset_z_mm and spindle_rpm.
/// host_ns is CLOCK_REALTIME and device_ns CLOCK_MONOTONIC, both taken at the reading itself, so
/// their difference changes only if somebody sets the clock.
///
/// Faults and what becomes of them:
///   no LinuxCNC, LinuxCNC ended      kConnecting, trouble says so; not counted as an error
///   kerf-hal dies, a torn record,
///   bytes that are no record         errors + 1, trouble, started again
///   silent for kSilence              errors + 1, trouble, started again
///   record of another version,
///   kerf-hal cannot be executed      kFailed: starting again would not help
///   readings missed or dropped       lost (gaps of HalSampleRecord::sequence)
/// Starts no thread and allocates nothing per sample. A stopped asking thread loses the oldest
/// samples last: about 200 wait in the pipe, later ones are counted as lost.
class HalSource final : public PositionSource {
 public:
  static constexpr std::chrono::milliseconds kSilence{5000};
  static constexpr std::chrono::milliseconds kShortestPause{500};
  static constexpr std::chrono::milliseconds kLongestPause{5000};

  /// Settings that validate() has no fault with. Nothing is started before the first next().
  explicit HalSource(HalSettings settings);
  /// Ends kerf-hal and waits for it (it leaves HAL in order).
  ~HalSource() override;

  Next next(AxisSample& sample, std::chrono::milliseconds patience) override;
  const SourceStatus& status() const override;
  std::string describe() const override;

  /// What the pins kerf.* are to show, from any thread. On its way when the asking thread is in
  /// next(), at most one sample later. To be said at least twice a second, or the pins say stale;
  /// what was said while LinuxCNC was away is dropped.
  void show(const HalStatus& status);

  /// What AxisSample has no room for: velocity, all tool offsets, program running or paused, and
  /// whether the pins kerf.* are ours (kHalPinsTaken). Of the last sample; from the asking thread.
  const HalSampleRecord& last_record() const;

 private:
  struct Reading;
  std::unique_ptr<Reading> reading_;
};

}  // namespace kerf
