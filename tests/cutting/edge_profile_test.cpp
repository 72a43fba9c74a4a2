// What the edge of a cutter adds up to, against closed forms.
#include "cutting/edge_profile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/cutting/edges_of.h"

namespace kerf {
namespace {

TEST(EdgeProfile, ACylinderIsAsLongAsItIsHigh) {
  const EdgeProfile profile = EdgeProfile::cylinder(5, 0.25);
  for (const double height : {0.0, 0.3, 12.0}) {
    const EdgeProfile::Sum sum = profile.sum_to(height);
    EXPECT_DOUBLE_EQ(sum.push_mm, height);
    EXPECT_DOUBLE_EQ(sum.inward_mm, height);
    EXPECT_DOUBLE_EQ(sum.turn_mm2, 5 * height);
    EXPECT_DOUBLE_EQ(sum.length_mm, height);
    EXPECT_DOUBLE_EQ(profile.radius_to(height), 5);
  }
  EXPECT_DOUBLE_EQ(profile.steepest_to(1), 1);
}

/// A quarter of a circle is pi/2 R long; for mc = 1 the integral of R / r dz is that, too, and of
/// r * R / r dz R^2. For mc = 0 they are R and pi/4 R^2.
TEST(EdgeProfile, ABallHasTheLengthOfItsArc) {
  const double radius = 4;
  const EdgeProfile one(ball_outline(radius), 1), none(ball_outline(radius), 0);
  EXPECT_NEAR(one.sum_to(radius).length_mm, kPi / 2 * radius, 1e-4);
  EXPECT_NEAR(one.sum_to(radius).push_mm, kPi / 2 * radius, 1e-2);
  EXPECT_NEAR(one.sum_to(radius).turn_mm2, radius * radius, 1e-2);
  EXPECT_NEAR(none.sum_to(radius).push_mm, radius, 1e-9);
  EXPECT_NEAR(none.sum_to(radius).turn_mm2, kPi / 4 * radius * radius, 1e-3);
  EXPECT_NEAR(one.sum_to(radius).half_mm2, kPi / 4 * radius * radius, 1e-3);
  for (const double height : {0.01, 0.1, 0.5, 2.0, 3.9}) {
    const double wide = std::sqrt(height * (2 * radius - height));
    EXPECT_NEAR(none.radius_to(height), wide, 0.01 * wide) << height;
    EXPECT_NEAR(none.steepest_to(height), wide / radius, 0.02) << height;
    EXPECT_NEAR(none.sum_to(height).length_mm, radius * std::acos(1 - height / radius), 0.01 * wide)
        << height;
  }
  EXPECT_NEAR(none.sum_to(radius + 3).turn_mm2, kPi / 4 * radius * radius + 3 * radius, 1e-3);
}

/// 90 degrees: sin(kappa) is the root of a half everywhere.
TEST(EdgeProfile, AConeIsTheSameAllTheWay) {
  const double mc = 0.3, steep = std::sqrt(0.5);
  const EdgeProfile profile(vee_outline(5, kPi / 4), mc);
  for (const double height : {0.2, 1.0, 4.5}) {
    const EdgeProfile::Sum sum = profile.sum_to(height);
    EXPECT_NEAR(sum.push_mm, height * std::pow(steep, -mc), 1e-6);
    EXPECT_NEAR(sum.inward_mm, height * std::pow(steep, 1 - mc), 1e-6);
    EXPECT_NEAR(sum.turn_mm2, height * height / 2 * std::pow(steep, -mc), 1e-3);
    EXPECT_NEAR(sum.length_mm, height / steep, 1e-6);
    EXPECT_NEAR(profile.radius_to(height), height, 1e-3);
  }
}

TEST(EdgeProfile, ABullNoseIsAQuarterOfAnArcAndASide) {
  const EdgeProfile profile(bull_outline(6, 2), 0);
  EXPECT_NEAR(profile.side_from_mm(), 2, 1e-12);
  EXPECT_NEAR(profile.sum_to(5).length_mm, kPi + 3, 1e-4);
  EXPECT_NEAR(profile.sum_to(2).turn_mm2, 4 * 2 + kPi, 1e-3);
  EXPECT_NEAR(profile.radius_to(0), 4, 1e-9);
}

}  // namespace
}  // namespace kerf
