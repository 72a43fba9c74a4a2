#include "base/curve_scale.h"

#include <gtest/gtest.h>

#include <vector>

namespace kerf {
namespace {

TEST(CurveScale, EndsAtTheGreatestWhereThatIsNoPeak) {
  const std::vector<float> values{0, 10, 12, 14, 0, 9};
  const CurveScale scale = scale_of(values);
  EXPECT_EQ(scale.top, 14);
  EXPECT_EQ(scale.most, 14);
  EXPECT_FALSE(scale.is_clipped);
}

TEST(CurveScale, APeakOfAColumnFlattensNothing) {
  std::vector<float> values(500, 10.0f);
  values[100] = 400;
  for (std::size_t i = 0; i < 200; ++i) values.push_back(0);  // where nothing is does not count
  const CurveScale scale = scale_of(values);
  EXPECT_EQ(scale.top, 10);
  EXPECT_EQ(scale.most, 400);
  EXPECT_TRUE(scale.is_clipped);
  values[100] = 14;  // less than half as much again
  EXPECT_EQ(scale_of(values).top, 14);
  EXPECT_FALSE(scale_of(values).is_clipped);
}

/// What lasts for 2 % of the time is no moment's peak.
TEST(CurveScale, WhatLastsIsSeenInFull) {
  std::vector<float> values(980, 10.0f);
  values.insert(values.end(), 20, 400.0f);
  EXPECT_EQ(scale_of(values).top, 400);
}

TEST(CurveScale, RangesAndLimitsNearThemAreSeen) {
  const std::vector<float> values(100, 10.0f), high(100, 13.0f);
  EXPECT_EQ(scale_of(values, high).top, 13);
  EXPECT_EQ(scale_of(values, high).most, 10);
  EXPECT_NEAR(scale_of(values, high, 20).top, 22, 1e-9) << "a tenth above the limit";
  EXPECT_EQ(scale_of(values, high, 5).top, 13) << "the limit is below";
  EXPECT_EQ(scale_of(values, high, 300).top, 13) << "so far off it would flatten the curve";
}

TEST(CurveScale, OfNothingThereIsNone) {
  EXPECT_EQ(scale_of({}).top, 0);
  EXPECT_EQ(scale_of(std::vector<float>(3, 0.0f), {}, 5).top, 0);
}

}  // namespace
}  // namespace kerf
