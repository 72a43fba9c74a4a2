#include "interp_bridge/timing/spindle_speed.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kerf {
namespace {

/// 180 m/min, at most 2500 rpm, about X0.
Motion facing(double from_x, double to_x) {
  Motion m;
  m.kind = MotionKind::kFeed;
  m.spindle = SpindleState::kClockwise;
  m.feed_per_rev = true;
  m.feed_mm_per_min = 0.2;
  m.surface = {180000, 2500, 0};
  m.from_mm = {from_x, 0, 0};
  m.to_mm = {to_x, 0, 0};
  m.spindle_rpm = m.surface.rpm_at(to_x);
  return m;
}

TEST(SpindleSpeed, FollowsTheRadiusUpToTheCap) {
  const Motion m = facing(26, 6);
  EXPECT_NEAR(spindle_rpm_at(m, 0), 180000 / (2 * kPi * 26), 1e-9);
  EXPECT_NEAR(spindle_rpm_at(m, 0.5), 180000 / (2 * kPi * 16), 1e-9);
  EXPECT_EQ(spindle_rpm_at(m, 1), 2500);
  Motion g97 = m;
  g97.surface = {};
  g97.spindle_rpm = 700;
  EXPECT_EQ(spindle_rpm_at(g97, 0.5), 700);
}

TEST(SpindleSpeed, PeakWhereTheCapIsReachedFirst) {
  const double cap_mm = 180000 / (2 * kPi * 2500);
  SpindlePeak peak = peak_spindle_rpm(facing(26, -6));
  EXPECT_EQ(peak.rpm, 2500);
  EXPECT_NEAR(peak.share, (26 - cap_mm) / 32, 1e-12);
  peak = peak_spindle_rpm(facing(20, 26));
  EXPECT_NEAR(peak.rpm, 180000 / (2 * kPi * 20), 1e-9);
  EXPECT_EQ(peak.share, 0);
  peak = peak_spindle_rpm(facing(-26, 20));
  EXPECT_EQ(peak.rpm, 2500);
  EXPECT_NEAR(peak.share, (26 - cap_mm) / 46, 1e-12);
  peak = peak_spindle_rpm(facing(5, 5));
  EXPECT_EQ(peak.share, 0);
}

/// A half circle in the plane of X and Z that comes nearest to the axis half way.
TEST(SpindleSpeed, OfAnArcWhereItIsNearest) {
  Motion m = facing(20, 20);
  m.kind = MotionKind::kArc;
  m.to_mm.z = -10;
  m.arc = {{20, 0, -5}, {0, 1, 0}, 0};
  m.arc.sweep_rad = kPi;
  const bool inwards = spindle_rpm_at(m, 0.5) > spindle_rpm_at(m, 0);
  if (!inwards) m.arc.sweep_rad = -kPi;
  EXPECT_NEAR(spindle_rpm_at(m, 0.5), 180000 / (2 * kPi * 15), 1e-6);
  const SpindlePeak peak = peak_spindle_rpm(m);
  EXPECT_NEAR(peak.share, 0.5, 1e-4);
  EXPECT_NEAR(peak.rpm, 180000 / (2 * kPi * 15), 1e-3);
}

/// A feed per revolution f takes the integral of 1 / (f n) along the way: with n = K / x that of
/// x, and where the cap holds of a constant.
TEST(SpindleFeed, TakesTheIntegralOverTheRadius) {
  const double k = 180000 / (2 * kPi), cap_mm = k / 2500;
  const SpindleFeed feed = spindle_feed(facing(26, 0), 0.2, 26, {}, -1, 1e6);
  const double seconds =
      (26 * 26 - cap_mm * cap_mm) / 2 / (0.2 * k / 60) + cap_mm / (0.2 * 2500 / 60);
  EXPECT_NEAR(26 / feed.mean, seconds, 1e-3 * seconds);
  EXPECT_NEAR(feed.most, 0.2 * 2500 / 60, 1e-9);
  const SpindleFeed out = spindle_feed(facing(0, 26), 0.2, 26, {}, -1, 1e6);
  EXPECT_NEAR(out.mean, feed.mean, 1e-9);
}

/// Without a cap it gets as fast as its drive makes it: stepped in time.
TEST(SpindleFeed, ASpindleIsLateWhereItCannotFollow) {
  Motion m = facing(30, 0.5);
  m.surface = {150000, 1e30, 0};
  SpindleDrive drive;
  drive.accel_rpm_per_s = 5000;
  const SpindleFeed feed = spindle_feed(m, 0.15, 29.5, drive, -1, 1e6);
  double x = 30, rpm = m.surface.rpm_at(30), seconds = 0;
  constexpr double kStep_s = 1e-5;
  for (; x > 0.5; seconds += kStep_s) {
    x -= 0.15 * rpm / 60 * kStep_s;
    rpm = std::min(m.surface.rpm_at(x), rpm + 5000 * kStep_s);
  }
  EXPECT_NEAR(29.5 / feed.mean, seconds, 2e-3 * seconds);
  EXPECT_NEAR(feed.end_rpm, rpm, 0.02 * rpm);
  EXPECT_LT(feed.end_rpm, 8000);
}

TEST(SpindleDriveTime, UntilItIsNear) {
  SpindleDrive drive;
  drive.accel_rpm_per_s = 5000;
  SpindleSpeed spindle(drive);
  // To a tenth below 3000, and as late as it is measured.
  const double until_s = 3000 / 1.1 / 5000;
  const double wait_s = spindle.wait_until_near(3000);
  EXPECT_NEAR(wait_s, until_s + SpindleDrive::kMeasured_s, 0.002);
  spindle.stand(3000, 1);
  EXPECT_EQ(spindle.rpm(), 3000);
  EXPECT_EQ(spindle.wait_until_near(3000), 0);
  EXPECT_GT(spindle.wait_until_near(-3000), 1);
  SpindleSpeed ideal(SpindleDrive{});
  EXPECT_EQ(ideal.wait_until_near(3000), 0);
}

}  // namespace
}  // namespace kerf
