#include "twin/live/feed_meter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kerf {
namespace {

TEST(FeedMeter, StraightAtEvenSpeed) {
  // 25 mm/s = 1500 mm/min, along a slant: 3-4-5.
  FeedMeter meter;
  EXPECT_FALSE(meter.mm_per_min());
  for (int ms = 0; ms <= 500; ++ms) {
    const double s = 0.001 * ms;
    meter.take(s, {15.0 * s, 20.0 * s, 0.0});
    if (ms < 50) {
      EXPECT_FALSE(meter.mm_per_min()) << ms;
    }
  }
  ASSERT_TRUE(meter.mm_per_min());
  EXPECT_NEAR(*meter.mm_per_min(), 1500.0, 1e-6);
}

TEST(FeedMeter, RoundAnArc) {
  // r 5 mm at 25 mm/s: 5 rad/s, 0.1 rad in 20 ms, whose chord is 0.9996 of the arc.
  FeedMeter meter;
  for (int ms = 0; ms <= 1000; ++ms) {
    const double angle = 5.0 * 0.001 * ms;
    meter.take(0.001 * ms, {5.0 * std::cos(angle), 5.0 * std::sin(angle), 0.0});
  }
  EXPECT_NEAR(*meter.mm_per_min(), 1500.0, 1500.0 * 0.001);
  EXPECT_LT(*meter.mm_per_min(), 1500.0);
}

TEST(FeedMeter, AChangeIsThereAfterTheWindow) {
  FeedMeter meter;
  double x = 0.0;
  for (int ms = 0; ms <= 1000; ++ms) meter.take(0.001 * ms, {x += 0.025, 0.0, 0.0});
  for (int ms = 1001; ms <= 1100; ++ms) meter.take(0.001 * ms, {x, 0.0, 0.0});
  EXPECT_NEAR(*meter.mm_per_min(), 750.0, 90.0) << "half of the window stands";
  for (int ms = 1101; ms <= 1230; ++ms) meter.take(0.001 * ms, {x, 0.0, 0.0});
  EXPECT_EQ(*meter.mm_per_min(), 0.0);
}

TEST(FeedMeter, AScaleThatTremblesStandsStill) {
  // One step of 0.001 mm to and fro each ms is 60 mm/min from sample to sample; from one place to
  // one 20 ms on it is 3 mm/min at most.
  FeedMeter meter;
  for (int ms = 0; ms <= 1000; ++ms) meter.take(0.001 * ms, {ms % 2 == 0 ? 0.0 : 0.001, 0.0, 0.0});
  EXPECT_LE(*meter.mm_per_min(), 3.0);
}

TEST(FeedMeter, SlowSources) {
  FeedMeter meter;
  for (int i = 0; i <= 8; ++i) meter.take(0.5 * i, {10.0 * i, 0.0, 0.0});
  EXPECT_NEAR(*meter.mm_per_min(), 1200.0, 1e-9);
}

TEST(FeedMeter, NothingIsSaidAcrossAGapOrABackwardClock) {
  FeedMeter meter;
  const auto run = [&](double from_s) {
    for (int ms = 0; ms <= 300; ++ms) meter.take(from_s + 0.001 * ms, {0.01 * ms, 0.0, 0.0});
  };
  run(0.0);
  EXPECT_NEAR(*meter.mm_per_min(), 600.0, 1e-6);
  meter.take(10.0, {500.0, 0.0, 0.0});
  EXPECT_FALSE(meter.mm_per_min());
  run(20.0);
  EXPECT_NEAR(*meter.mm_per_min(), 600.0, 1e-6);
  meter.take(1.0, {0.0, 0.0, 0.0});
  EXPECT_FALSE(meter.mm_per_min());
  run(2.0);
  meter.take(2.3, {3.0, 0.0, 0.0});  // twice the same stamp
  EXPECT_NEAR(*meter.mm_per_min(), 600.0, 1e-6);
}

}  // namespace
}  // namespace kerf
