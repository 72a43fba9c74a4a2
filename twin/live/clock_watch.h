// twin/live/clock_watch.h - whether this computer's clock was set while a machine was watched.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace kerf {

/// CLOCK_REALTIME, ns.
std::int64_t real_time_ns();

/// The clock is held against the one that nobody can set, both read at the same moment: a sample
/// that reaches kerf late says nothing of its clock. One thread.
class ClockWatch {
 public:
  /// The least that is told.
  static constexpr double kStep_s = 0.2;

  /// `real_ns`: the clock; of this computer unless a test has another.
  explicit ClockWatch(std::function<std::int64_t()> real_ns = real_time_ns)
      : real_ns_(std::move(real_ns)) {}

  /// By how much the clock was set between the last sample and this one, ns; 0: it was not.
  /// `stamp_ns`: of the clock, when the sample was read; `arrival_ns`: of the steady clock, when it
  /// was here. A sample that was read before the clock was set, and came after, is still of the
  /// time before.
  std::int64_t set_by(std::int64_t stamp_ns, std::int64_t arrival_ns);

 private:
  std::int64_t offset_ns() const;

  std::function<std::int64_t()> real_ns_;
  std::optional<std::int64_t> offset_ns_;  ///< of the clocks, for the last sample
};

}  // namespace kerf
