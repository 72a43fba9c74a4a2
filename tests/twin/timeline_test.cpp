#include "twin/timeline.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(MotionGeometry, BoundsOfAnArcHoldItsPoints) {
  MotionList program;
  program.at({10, 0, 0}).arc({-8, 0, -4}, {0, 0, 0}, {0, 0, 1}, kPi);
  const Motion& arc = program.last();
  const Box box = bounds_of(arc);
  for (int i = 0; i <= 100; ++i) {
    const Vec3 p = point_at(arc, i / 100.0);
    Box grown = box;
    grown.extend(p);
    EXPECT_LT((grown.max - box.max).x + (box.min - grown.min).y + (box.min - grown.min).z, kTight);
  }
  EXPECT_NEAR(point_at(arc, 1).x, -8, kTight) << "a spiral ends at its end";
}

}  // namespace
}  // namespace kerf
