#include "twin/live/log_pace.h"

#include <algorithm>
#include <cmath>
#include <thread>

namespace kerf {
namespace {

/// Who waits looks so often whether the speed has changed.
constexpr std::chrono::milliseconds kLookRound{50};

}  // namespace

std::int64_t stamp_of(const AxisSample& sample) {
  return sample.device_ns != AxisSample::kNoTime ? sample.device_ns : sample.host_ns;
}

void LogPace::wait_for(const AxisSample& sample, const std::stop_token& stop) {
  const std::int64_t stamp = stamp_of(sample);
  if (stamp == AxisSample::kNoTime) return;
  while (!stop.stop_requested()) {
    const double speed = speed_;
    const auto now = Clock::now();
    if (!paced_from_ns_ || speed != paced_speed_) {
      // From where the log has come to, not from where it should be: what was late stays late.
      paced_from_ns_ = paced_ns_.value_or(stamp);
      paced_since_ = now;
      paced_speed_ = speed;
    }
    paced_ns_ = std::max(paced_ns_.value_or(stamp), *paced_from_ns_);
    if (!std::isfinite(speed)) break;
    if (speed > 0) {
      const double due_s = static_cast<double>(stamp - *paced_from_ns_) * 1e-9 / speed;
      const auto due = paced_since_ + std::chrono::duration_cast<Clock::duration>(
                                          std::chrono::duration<double>(due_s));
      if (now >= due) break;
      std::this_thread::sleep_until(std::min(due, now + kLookRound));
    } else {
      std::this_thread::sleep_for(kLookRound);
    }
  }
  paced_ns_ = stamp;
}

}  // namespace kerf
