#include "machine_io/modbus/poll_schedule.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using std::chrono::milliseconds;

TEST(PollSchedule, is_due_on_a_grid_however_late_each_poll_begins) {
  PollSchedule schedule(100);
  const SteadyClock::time_point start{std::chrono::hours(1)};
  schedule.start(start);
  EXPECT_EQ(schedule.due(), start);
  schedule.begun(start + milliseconds(1));
  EXPECT_EQ(schedule.due(), start + milliseconds(10));
  schedule.begun(start + milliseconds(19));
  EXPECT_EQ(schedule.due(), start + milliseconds(20));
}

TEST(PollSchedule, what_was_missed_is_not_made_up_for) {
  PollSchedule schedule(100);
  const SteadyClock::time_point start{std::chrono::hours(1)};
  schedule.start(start);
  schedule.begun(start + milliseconds(57));
  EXPECT_EQ(schedule.due(), start + milliseconds(60));
  schedule.begun(start + milliseconds(60));
  EXPECT_EQ(schedule.due(), start + milliseconds(70));
  schedule.begun(start + milliseconds(80));
  EXPECT_EQ(schedule.due(), start + milliseconds(90));
}

TEST(PollSchedule, sleeps_until_the_time_and_not_at_all_for_the_past) {
  const auto begin = SteadyClock::now();
  sleep_until(begin - std::chrono::hours(1));
  sleep_until(begin + milliseconds(20));
  EXPECT_GE(SteadyClock::now(), begin + milliseconds(20));
}

TEST(BackOff, doubles_from_100_ms_to_5_s) {
  BackOff back_off;
  for (const int wanted : {100, 200, 400, 800, 1600, 3200, 5000, 5000}) {
    EXPECT_EQ(back_off.next(), milliseconds(wanted));
  }
  back_off.reset();
  EXPECT_EQ(back_off.next(), milliseconds(100));
}

TEST(HostStamp, never_goes_back_and_follows_the_clock_forward) {
  HostStamp stamps;
  constexpr std::int64_t kSecond = 1'000'000'000;
  std::int64_t real = 1000 * kSecond;
  EXPECT_EQ(stamps.stamp(real, 5 * kSecond), real);
  EXPECT_EQ(stamps.stamp(real + kSecond, 6 * kSecond), real + kSecond);
  EXPECT_EQ(stamps.stepped_back_ns(), 0);
  // An hour back: the stamps go on by the steady clock.
  real -= 3600 * kSecond;
  EXPECT_EQ(stamps.stamp(real + 2 * kSecond, 7 * kSecond), 1002 * kSecond);
  EXPECT_EQ(stamps.stepped_back_ns(), 3600 * kSecond);
  EXPECT_EQ(stamps.stamp(real + 3 * kSecond, 8 * kSecond), 1003 * kSecond);
  EXPECT_EQ(stamps.stepped_back_ns(), 0);
  // Two hours forward.
  real += 7200 * kSecond;
  EXPECT_EQ(stamps.stamp(real + 4 * kSecond, 9 * kSecond), real + 4 * kSecond);
  EXPECT_EQ(stamps.stepped_back_ns(), 0);
}

TEST(HostStamp, slewing_is_no_step) {
  HostStamp stamps;
  stamps.stamp(1'000'000'000, 0);
  EXPECT_GT(stamps.stamp(1'009'000'000, 10'000'000), 1'000'000'000);
  EXPECT_EQ(stamps.stepped_back_ns(), 0);
}

}  // namespace
}  // namespace kerf
