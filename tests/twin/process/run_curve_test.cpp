#include "twin/process/run_curve.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace kerf {
namespace {

RunCurve::Column sum_of(const RunCurve& curve) {
  RunCurve::Column sum;
  for (const RunCurve::Column& column : curve.columns()) {
    sum.removed_mm3 += column.removed_mm3;
    sum.feed_mm += column.feed_mm;
    sum.feed_s += column.feed_s;
    sum.turns += column.turns;
  }
  return sum;
}

TEST(RunCurve, SpreadsAMotionOverItsTime) {
  RunCurve curve;
  ASSERT_DOUBLE_EQ(curve.step_s(), 0.0625);
  curve.add({0.03125, 0.125, 8, 4, 600});  // half a column, a whole one, half a one
  ASSERT_EQ(curve.columns().size(), 3u);
  EXPECT_DOUBLE_EQ(curve.columns()[0].removed_mm3, 2);
  EXPECT_DOUBLE_EQ(curve.columns()[1].removed_mm3, 4);
  EXPECT_DOUBLE_EQ(curve.columns()[2].removed_mm3, 2);
  EXPECT_DOUBLE_EQ(curve.columns()[1].feed_s, 0.0625);
  EXPECT_DOUBLE_EQ(curve.columns()[1].turns, 0.625);
}

TEST(RunCurve, KeepsItsSumsHoweverLongItGets) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  RunCurve curve;
  double clock_s = 0, removed = 0, way = 0, turns = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double duration_s = i % 11 == 0 ? 0 : 3 * unit(random);
    const RunCurve::Share share{clock_s, duration_s, unit(random), unit(random),
                                3000 * unit(random)};
    curve.add(share);
    clock_s += duration_s;
    removed += share.removed_mm3;
    way += share.feed_mm;
    turns += share.rpm * duration_s / 60;
  }
  EXPECT_LE(curve.columns().size(), RunCurve::kMost);
  EXPECT_GT(curve.columns().size(), RunCurve::kMost / 2);
  const RunCurve::Column sum = sum_of(curve);
  EXPECT_NEAR(sum.removed_mm3, removed, 1e-6 * removed);
  EXPECT_NEAR(sum.feed_mm, way, 1e-6 * way);
  EXPECT_NEAR(sum.turns, turns, 1e-6 * turns);
}

TEST(RunCurve, LeavesOutWhatHasNoTime) {
  RunCurve curve;
  curve.add({-1, 2, 5, 5, 5});
  curve.add({1, std::numeric_limits<double>::infinity(), 5, 5, 5});
  EXPECT_TRUE(curve.columns().empty());
}

}  // namespace
}  // namespace kerf
