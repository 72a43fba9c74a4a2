#include "machine_io/modbus/poll_schedule.h"

#include <algorithm>
#include <cmath>

namespace kerf {

PollSchedule::PollSchedule(double polls_per_s)
    : period_(std::chrono::nanoseconds(std::llround(1e9 / polls_per_s))) {}

void PollSchedule::begun(SteadyClock::time_point now) {
  const auto passed = std::max<SteadyClock::rep>(0, (now - due_) / period_);
  due_ += period_ * (passed + 1);
}

}  // namespace kerf
