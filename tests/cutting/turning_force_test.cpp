// Force, torque and power of turning, by hand.
#include "cutting/turning_force.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kerf {
namespace {

Material turned_steel() {
  Material material;
  material.kc11_n_per_mm2 = {1500, 2000, 2600};
  material.mc = 0.25;
  return material;
}

/// 3 mm deep, 0.3 mm a turn, kappa 45 degrees, at radius 25 with 1000 rpm: h = 0.2121 mm, kc = 2000
/// * 1.4735 = 2947 N/mm2, Fc = 2947 * 0.9 = 2652 N; torque = 66.3 Nm; vc = 157.1 m/min; power =
/// 2652 * 157.1 / 60 = 6943 W.
TEST(TurningForce, IsWorkedOutByHand) {
  const TurningLoad load = turning_load(turned_steel(), {3, 0.3, std::sqrt(0.5), 25, 1000});
  EXPECT_NEAR(load.chip_mm, 0.2121, 1e-4);
  EXPECT_NEAR(load.force_n.nominal, 2652, 2);
  EXPECT_NEAR(load.force_n.low, 2652 * 0.75, 2);
  EXPECT_NEAR(load.force_n.high, 2652 * 1.3, 2);
  EXPECT_NEAR(load.torque_nm.nominal, 66.3, 0.05);
  EXPECT_NEAR(load.speed_m_per_min, 157.1, 0.05);
  EXPECT_NEAR(load.power_w.nominal, 6943, 5);
}

/// A larger lead angle makes thicker chips, which take less force for the same section.
TEST(TurningForce, ThickChipsTakeLessThanThinOnes) {
  const double square = turning_load(turned_steel(), {3, 0.3, 1, 25, 1000}).force_n.nominal;
  EXPECT_NEAR(square, 2652 * std::pow(0.5, 0.125), 2);
}

TEST(TurningForce, NothingIsTakenByNothing) {
  EXPECT_EQ(turning_load(turned_steel(), {0, 0.3, 1, 25, 1000}).power_w.high, 0);
  EXPECT_EQ(turning_load(turned_steel(), {3, 0, 1, 25, 1000}).force_n.high, 0);
}

}  // namespace
}  // namespace kerf
