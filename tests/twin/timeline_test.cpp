#include "twin/timeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/twin/motions.h"
#include "twin/motion_geometry.h"

namespace kerf {
namespace {

constexpr double kTight = 1e-9;

MotionTotals totals_of(const MotionList& program, double traverse_rate = 6000) {
  Timeline timeline(TimelineOptions{traverse_rate});
  for (const Motion& m : program.list()) timeline.add(m);
  return timeline.totals();
}

TEST(Timeline, FeedsTakeLengthByFeedAndTraversesTheStatedRate) {
  const MotionTotals totals =
      totals_of(MotionList().traverse({60, 80, 0}).feed_rate(300).feed({60, 80, -10}));
  EXPECT_NEAR(totals.traverse_mm, 100, kTight);
  EXPECT_NEAR(totals.feed_mm, 10, kTight);
  EXPECT_NEAR(totals.duration_s, 1.0 + 2.0, kTight);
  EXPECT_EQ(totals.moves, 2U);
  EXPECT_EQ(totals.feed_moves, 1U);
  EXPECT_EQ(totals.traverse_moves, 1U);
}

TEST(Timeline, DwellsTakeWhatTheySayAndToolChangesNothing) {
  EXPECT_NEAR(totals_of(MotionList().tool(1).dwell(1.5)).duration_s, 1.5, kTight);
}

TEST(Timeline, FeedPerRevolutionTakesTheSpindleSpeed) {
  MotionList program;
  program.spindle(true).feed_rate(0.1).feed({100, 0, 0});
  program.last().feed_per_rev = true;
  program.last().spindle_rpm = 1200;  // 120 mm/min
  EXPECT_NEAR(totals_of(program).duration_s, 50, kTight);
}

TEST(Timeline, FeedWithoutRateTakesNoTimeAndIsCounted) {
  const MotionTotals totals = totals_of(MotionList().feed_rate(0).feed({10, 0, 0}));
  EXPECT_EQ(totals.duration_s, 0);
  EXPECT_EQ(totals.moves_without_feed, 1U);
}

TEST(Timeline, FirstMoveWithUnknownStartHasNoLength) {
  MotionList program;
  program.traverse({100, 0, 0});
  program.last().start_known = false;
  EXPECT_EQ(totals_of(program).traverse_mm, 0);
  EXPECT_EQ(totals_of(program).moves, 1U);
}

TEST(Timeline, RotaryMovesTakeDegreesPerMinute) {
  MotionList program;
  program.feed_rate(360).feed({0, 0, 0});
  program.last().to_abc_deg = {90, 0, 0};
  EXPECT_NEAR(totals_of(program).duration_s, 15, kTight);
}

TEST(Timeline, HelixOfThreeTurns) {
  MotionList program;
  program.at({10, 0, 0}).arc({10, 0, -6}, {0, 0, 0}, {0, 0, 1}, 6 * kPi);
  EXPECT_NEAR(totals_of(program).feed_mm, std::hypot(60 * kPi, 6.0), kTight);
}

TEST(MotionGeometry, PointsOfAnArcInXzTurnByTheRightHand) {
  MotionList program;
  // About +Y a quarter turn takes +Z to +X.
  program.at({0, 5, 3}).arc({3, 5, 0}, {0, 5, 0}, {0, 1, 0}, kPi / 2);
  const Vec3 middle = point_at(program.last(), 0.5);
  EXPECT_NEAR(middle.x, 3 / std::sqrt(2.0), kTight);
  EXPECT_NEAR(middle.y, 5, kTight);
  EXPECT_NEAR(middle.z, 3 / std::sqrt(2.0), kTight);
}

/// How far points of the way lie outside the box, and how much the box is larger than needed. mm.
struct BoxFit {
  double outside = 0;
  double loose = 0;
};
BoxFit fit_of(const Motion& m) {
  Box exact;
  for (int i = 0; i <= 3600; ++i) exact.extend(point_at(m, i / 3600.0));
  const Box box = bounds_of(m);
  BoxFit fit;
  for (int i = 0; i < 3; ++i) {
    fit.outside = std::max({fit.outside, box.min[i] - exact.min[i], exact.max[i] - box.max[i]});
    fit.loose = std::max({fit.loose, exact.min[i] - box.min[i], box.max[i] - exact.max[i]});
  }
  return fit;
}

TEST(MotionGeometry, BoundsOfArcsAreExactInAPlane) {
  for (const double start_deg : {0.0, 30.0, 100.0, 200.0, 359.0}) {
    for (const double sweep_deg : {1.0, -1.0, 45.0, -120.0, 180.0, 300.0, -360.0, 800.0}) {
      for (const Vec3 axis : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0.6, 0, 0.8)}) {
        const Vec3 u = glm::normalize(glm::cross(axis, Vec3(0.3, 0.5, -0.2)));
        const Vec3 v = glm::cross(axis, u);
        const Vec3 center(5, 6, 7);
        const auto at = [&](double deg) {
          return center + 10.0 * (std::cos(deg * kPi / 180) * u + std::sin(deg * kPi / 180) * v);
        };
        MotionList program;
        program.at(at(start_deg))
            .arc(at(start_deg + sweep_deg), center, axis, sweep_deg * kPi / 180);
        const BoxFit fit = fit_of(program.last());
        EXPECT_LT(fit.outside, 1e-9) << start_deg << " " << sweep_deg;
        EXPECT_LT(fit.loose, 1e-4) << start_deg << " " << sweep_deg;
      }
    }
  }
}

TEST(MotionGeometry, BoundsOfSpiralHelicesHoldThem) {
  MotionList program;
  program.at({10, 0, 0}).arc({-8, 0, -4}, {0, 0, 0}, {0, 0, 1}, 3 * kPi);
  EXPECT_LT(fit_of(program.last()).outside, 1e-9);
  EXPECT_NEAR(point_at(program.last(), 1).x, -8, kTight) << "a spiral ends at its end";
}

}  // namespace
}  // namespace kerf
