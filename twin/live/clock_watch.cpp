#include "twin/live/clock_watch.h"

#include <chrono>
#include <cstdlib>
#include <limits>

namespace kerf {
namespace {

constexpr std::int64_t kStep_ns = static_cast<std::int64_t>(ClockWatch::kStep_s * 1e9);
/// Readings that lie farther apart, because another process came in between, are made again.
constexpr std::int64_t kApart_ns = 1'000'000;
constexpr int kTries = 10;

template <class Clock>
std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch())
      .count();
}

}  // namespace

std::int64_t real_time_ns() { return now_ns<std::chrono::system_clock>(); }

/// Of the readings that lie closest together.
std::int64_t ClockWatch::offset_ns() const {
  std::int64_t apart_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t offset_ns = 0;
  for (int i = 0; i < kTries && apart_ns > kApart_ns; ++i) {
    const std::int64_t before_ns = now_ns<std::chrono::steady_clock>();
    const std::int64_t real_ns = real_ns_();
    const std::int64_t took_ns = now_ns<std::chrono::steady_clock>() - before_ns;
    if (took_ns >= apart_ns) continue;
    apart_ns = took_ns;
    offset_ns = real_ns - before_ns;
  }
  return offset_ns;
}

std::int64_t ClockWatch::set_by(std::int64_t stamp_ns, std::int64_t arrival_ns) {
  const std::int64_t now_ns = offset_ns();
  if (!offset_ns_) {
    offset_ns_ = now_ns;
    return 0;
  }
  const std::int64_t by_ns = now_ns - *offset_ns_;
  if (std::abs(by_ns) <= kStep_ns) {
    offset_ns_ = now_ns;
    return 0;
  }
  const std::int64_t stamped_ns = stamp_ns - arrival_ns;
  if (std::abs(stamped_ns - *offset_ns_) < std::abs(stamped_ns - now_ns)) return 0;
  offset_ns_ = now_ns;
  return by_ns;
}

}  // namespace kerf
