// The loads of cuts over the time of a program.
#include "twin/process/load_curve.h"

#include <gtest/gtest.h>

#include <limits>

namespace kerf {
namespace {

CutLoad load_at(double start_s, double seconds, double force_n, double high_n) {
  CutLoad load;
  load.is_engaged = true;
  load.start_s = start_s;
  load.seconds = seconds;
  load.set(LoadKind::kForce, {force_n, force_n, high_n});
  return load;
}

TEST(LoadCurve, AColumnHasTheGreatestOfWhatIsInIt) {
  LoadCurve curve;
  EXPECT_TRUE(curve.nominal(LoadKind::kForce).empty());
  curve.on_load(load_at(0.125, 0.125, 100, 130));  // columns 2 and 3, and not the next
  curve.on_load(load_at(0.2, 0.01, 300, 320));     // column 3
  curve.on_load(load_at(0.21, 0.01, 50, 400));     // and a wider range there
  const auto nominal = curve.nominal(LoadKind::kForce), high = curve.high(LoadKind::kForce);
  ASSERT_EQ(nominal.size(), 4u);
  ASSERT_EQ(high.size(), 4u);
  EXPECT_EQ(nominal[1], 0);
  EXPECT_EQ(nominal[2], 100);
  EXPECT_EQ(nominal[3], 300);
  EXPECT_EQ(high[2], 130);
  EXPECT_EQ(high[3], 400);
  EXPECT_TRUE(curve.nominal(LoadKind::kPower).empty()) << "nobody has told of it";
}

TEST(LoadCurve, OfALongProgramColumnsBecomeWiderAndLoseNoPeak) {
  LoadCurve curve;
  curve.on_load(load_at(10, 0.01, 700, 800));
  for (int i = 0; i < 1000; ++i) curve.on_load(load_at(10 * i, 5, 100, 110));
  EXPECT_EQ(curve.step_s(), 16) << "1 / 16 s, doubled until 9995 s are fewer than 1024 columns";
  const auto nominal = curve.nominal(LoadKind::kForce);
  EXPECT_LE(nominal.size(), LoadCurve::kMost);
  EXPECT_EQ(nominal[0], 700);
  EXPECT_EQ(nominal[1], 100);
  curve.restart();
  EXPECT_TRUE(curve.nominal(LoadKind::kForce).empty());
  EXPECT_EQ(curve.step_s(), LoadCurve::kFirstStep_s);
}

TEST(LoadCurve, WhatIsNoTimeIsLeftOut) {
  LoadCurve curve;
  curve.on_load(load_at(1, 0, 100, 100));
  curve.on_load(load_at(-1, 1, 100, 100));
  curve.on_load(load_at(std::numeric_limits<double>::infinity(), 1, 100, 100));
  EXPECT_TRUE(curve.nominal(LoadKind::kForce).empty());
}

}  // namespace
}  // namespace kerf
