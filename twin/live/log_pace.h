// twin/live/log_pace.h - when a sample of a log is due that is run again at some speed.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <stop_token>

#include "machine_io/position_source.h"

namespace kerf {

/// When the sample came: by its device's clock, else by the computer's; kNoTime: nobody says.
std::int64_t stamp_of(const AxisSample& sample);

/// The speed may change meanwhile, from any thread; all else is of the thread that reads the log.
class LogPace {
 public:
  /// Log seconds a second; 0 stands still, infinity goes as fast as it can.
  void set_speed(double speed) { speed_ = speed; }
  /// Waits until the sample is due, or somebody stops. One without a time is due at once.
  void wait_for(const AxisSample& sample, const std::stop_token& stop);

 private:
  using Clock = std::chrono::steady_clock;
  std::atomic<double> speed_{0};
  std::optional<std::int64_t> paced_from_ns_;  ///< stamp of the log when the speed last changed
  std::optional<std::int64_t> paced_ns_;       ///< of the last sample
  Clock::time_point paced_since_;
  double paced_speed_ = 0;
};

}  // namespace kerf
