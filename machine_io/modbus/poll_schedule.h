// machine_io/modbus/poll_schedule.h - when to poll. Times are given from outside, so that tests
// need no waiting.
#pragma once

#include <chrono>

#include "machine_io/source_clock.h"

namespace kerf {

/// Due times on a fixed grid.
class PollSchedule {
 public:
  explicit PollSchedule(double polls_per_s);
  /// The grid begins at `now`: the first poll is due at once.
  void start(SteadyClock::time_point now) { due_ = now; }
  SteadyClock::time_point due() const { return due_; }
  /// A poll was begun at `now`: the next is due at the first time of the grid after `now`. Those
  /// that were missed are not made up for.
  void begun(SteadyClock::time_point now);

 private:
  SteadyClock::duration period_;
  SteadyClock::time_point due_{};
};

}  // namespace kerf
