#include "machine_io/source_clock.h"

#include <time.h>

#include <algorithm>
#include <cerrno>

namespace kerf {

void sleep_until(SteadyClock::time_point time) {
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch());
  const timespec until{static_cast<time_t>(since.count() / 1'000'000'000),
                       static_cast<long>(since.count() % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

std::chrono::milliseconds BackOff::next() {
  const std::chrono::milliseconds wait = next_;
  next_ = std::min(2 * next_, kLongest);
  return wait;
}

std::int64_t HostStamp::stamp(std::int64_t real_ns, std::int64_t steady_ns) {
  const std::int64_t offset = real_ns - steady_ns;
  stepped_back_ns_ = 0;
  if (!started_) {
    offset_ns_ = offset;
  } else if (real_offset_ns_ - offset > kStepNs) {
    stepped_back_ns_ = real_offset_ns_ - offset;
  }
  started_ = true;
  real_offset_ns_ = offset;
  offset_ns_ = std::max(offset_ns_, offset);
  return steady_ns + offset_ns_;
}

}  // namespace kerf
