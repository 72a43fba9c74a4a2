#include "stock/turning/turned_gap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/stock/insert_points.h"
#include "tests/stock/turning/turning_oracle.h"

namespace kerf::turning_test {
namespace {

/// Jaws: 30 to 50 thick, Z-40 to Z-20.
TurnedPart jaws() { return *TurnedPart::create(tube_profile(-40, -20, 100, 60)); }

TEST(TurnedGap, ADiscThatPassesIsAsFarAsItsRimIs) {
  const TurningTool disc(round_insert(4));
  const auto before = least_gap(jaws(), disc, line({-10, 80}, {-10, 20}), 100);
  ASSERT_TRUE(before);
  EXPECT_NEAR(before->mm, 10 - 4, 2e-4);  // of the jaws' face, over their whole height
  EXPECT_NEAR(before->at_mm.x, -10, 1e-9);
  const auto over = least_gap(jaws(), disc, line({0, 60}, {-80, 60}), 100);
  ASSERT_TRUE(over);
  EXPECT_NEAR(over->mm, 10 - 4, 2e-4);
  EXPECT_NEAR(over->at_mm.x, -20, 0.5);  // first, where the rim is above the jaws' corner
  const auto corner = least_gap(jaws(), disc, line({-17, 54}, {-17, 54}), 100);
  ASSERT_TRUE(corner);
  EXPECT_NEAR(corner->mm, 5 - 4, 2e-4);  // 3 and 4 from the corner
}

TEST(TurnedGap, WhereItIsNearestOnASlantedWay) {
  // 45 degrees down past the jaws' outer corner (-20, 50): nearest beside it.
  const TurningTool disc(round_insert(1));
  const auto gap = least_gap(jaws(), disc, line({-20, 60}, {-10, 50}), 100);
  ASSERT_TRUE(gap);
  EXPECT_NEAR(gap->mm, 10 / std::sqrt(2.0) - 1, 2e-4);
  EXPECT_NEAR(gap->t, 0.5, 0.02);
}

TEST(TurnedGap, WhatIsFartherThanAskedForIsNone) {
  const TurningTool disc(round_insert(4));
  EXPECT_FALSE(least_gap(jaws(), disc, line({-10, 80}, {-10, 20}), 5.99));
  EXPECT_TRUE(least_gap(jaws(), disc, line({-10, 80}, {-10, 20}), 6.01));
}

TEST(TurnedGap, WhatTouchesIsNotApart) {
  const TurningTool disc(round_insert(4));
  // Across the corner, within the bore of another ring, and round the whole of a thin one.
  EXPECT_EQ(least_gap(jaws(), disc, line({-18, 80}, {-18, 20}), 100)->mm, 0);
  EXPECT_EQ(least_gap(jaws(), disc, line({-30, 40}, {-29, 40}), 100)->mm, 0);
  const TurnedPart wire = *TurnedPart::create(tube_profile(-30, -29.5, 80.2, 80));
  EXPECT_EQ(least_gap(wire, disc, line({-30, 41}, {-29, 41}), 100)->mm, 0);
}

TEST(TurnedGap, BeyondTheAxisTheRadiusCounts) {
  const TurningTool disc(round_insert(4));
  const auto gap = least_gap(jaws(), disc, line({-30, 0}, {-30, -20}), 100);
  ASSERT_TRUE(gap);
  EXPECT_NEAR(gap->mm, 30 - 20 - 4, 2e-4);
  EXPECT_NEAR(gap->t, 1, 2e-6);  // of 20 mm, with corners on steps of 10 nm
}

TEST(TurnedGap, ArcsOfTheWay) {
  // A half turn of radius 10 about (-20, 65): its lowest place is 5 above the jaws' corner.
  const TurningTool disc(round_insert(2));
  const auto gap = least_gap(jaws(), disc, arc({-30, 65}, {-20, 65}, 0.5), 100);
  ASSERT_TRUE(gap);
  EXPECT_NEAR(gap->mm, 5 - 2, 2e-4);
  EXPECT_NEAR(gap->t, 0.5, 0.01);
}

/// From the jaws, as they are above; 0 within.
double from_jaws_mm(const Vec2& p) {
  return std::hypot(std::max({0.0, -40 - p.x, p.x + 20}), std::max({0.0, 30 - p.y, p.y - 50}));
}

/// Of a tool at rest. The least is at a corner of one of the two, or on an arc of the tool.
double apart_mm(const InsertOutline& shape, const Vec2& at) {
  double least = 1e9;
  for (const InsertPart& part : shape.parts) {
    for (const Vec2& p : insert_points(part, 150))
      least = std::min({least, from_jaws_mm(at + p), from_jaws_mm({at.x + p.x, -at.y - p.y})});
  }
  for (const Vec2& corner : {Vec2(-40, 30), Vec2(-20, 30), Vec2(-20, 50), Vec2(-40, 50)}) {
    least = std::min({least, distance_to_tool(shape, corner - at),
                      distance_to_tool(shape, Vec2(corner.x, -corner.y) - at)});
  }
  return std::max(least, 0.0);
}

TEST(TurnedGap, AsADenseSamplerHasIt) {
  std::mt19937 random(7);  // NOLINT: equal each time
  std::uniform_real_distribution<double> z(-80, 20), x(-20, 90);
  const TurnedPart part = jaws();
  int apart = 0;
  for (int round = 0; round < 120; ++round) {
    const InsertOutline shape = random_tool(random);
    const TurnMove move = round % 4 == 0 ? arc({z(random), x(random)}, {z(random), x(random)}, 0.3)
                                         : line({z(random), x(random)}, {z(random), x(random)});
    constexpr int kSteps = 500;
    double sampled = 1e9;
    for (int k = 0; k <= kSteps && sampled > 0; ++k)
      sampled = std::min(sampled, apart_mm(shape, place_at(move, static_cast<double>(k) / kSteps)));
    const auto gap = least_gap(part, TurningTool(shape), move, 1000);
    ASSERT_TRUE(gap);
    // Half a step is as much as a place between two may be nearer.
    EXPECT_LE(gap->mm, sampled + 2e-4) << round;
    EXPECT_GE(gap->mm, sampled - length_of(move) / kSteps / 2 - 2e-4) << round;
    if (sampled < 0.3) continue;
    ++apart;
    EXPECT_NEAR(apart_mm(shape, gap->at_mm), gap->mm, 1e-3) << round;
  }
  EXPECT_GT(apart, 40);
}

}  // namespace
}  // namespace kerf::turning_test
