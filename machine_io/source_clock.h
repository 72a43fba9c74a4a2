// machine_io/source_clock.h - for sources that keep a connection: when to try again, and what time
// it is. Times are given from outside, so that tests need no waiting.
#pragma once

#include <chrono>
#include <cstdint>

namespace kerf {

/// CLOCK_MONOTONIC: unmoved when somebody sets the clock.
using SteadyClock = std::chrono::steady_clock;

/// Sleeps until `time`, absolutely: signals and slow wake-ups add no drift.
void sleep_until(SteadyClock::time_point time);

/// Waiting times between attempts: kFirst, doubling to kLongest.
class BackOff {
 public:
  static constexpr std::chrono::milliseconds kFirst{100};
  static constexpr std::chrono::milliseconds kLongest{5000};

  std::chrono::milliseconds next();
  void reset() { next_ = kFirst; }

 private:
  std::chrono::milliseconds next_ = kFirst;
};

/// Time stamps of CLOCK_REALTIME that never go back, as a source owes them to its reader. While the
/// clock runs evenly a stamp is the clock's. When it is set forward the stamps follow; when it is
/// set back they go on as if it had not been, until the clock has caught up.
class HostStamp {
 public:
  /// One step back by more than this is reported; less is the clock's discipline (NTP slewing).
  static constexpr std::int64_t kStepNs = 10'000'000;

  /// `real_ns` and `steady_ns` were read at the same moment. Returns the stamp.
  std::int64_t stamp(std::int64_t real_ns, std::int64_t steady_ns);
  /// By how much the clock was set back between the last two stamps, ns; 0: it was not.
  std::int64_t stepped_back_ns() const { return stepped_back_ns_; }

 private:
  bool started_ = false;
  std::int64_t offset_ns_ = 0;       ///< stamp = steady + offset; only grows
  std::int64_t real_offset_ns_ = 0;  ///< the clock's own, at the last stamp
  std::int64_t stepped_back_ns_ = 0;
};

}  // namespace kerf
