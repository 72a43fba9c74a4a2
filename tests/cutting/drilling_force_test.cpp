// Torque and thrust of drills, by hand.
#include "cutting/drilling_force.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geometry.h"

namespace kerf {
namespace {

Material steel() {
  Material material;
  material.kc11_n_per_mm2 = {1500, 2000, 2600};
  material.mc = 0.25;
  material.rake_deg = 6;
  return material;
}

/// 10 mm, 118 degrees, 0.2 mm a turn: h = 0.1 * sin 59 = 0.0857, kc = 2000 * 1.848 = 3696 N/mm2;
/// torque = 3696 * 0.2 * 100 / 8 = 9.24 Nm, thrust = 0.5 * 3696 * 5 * 0.2 * 0.857 = 1584 N, and at
/// 1000 rpm 9.24 * 104.7 = 968 W.
TEST(DrillingForce, IsWorkedOutByHand) {
  const DrillingLoad load = drilling_load(steel(), {10, 2, 118, 0.2, 1000}, {});
  EXPECT_NEAR(load.chip_mm, 0.0857, 1e-4);
  EXPECT_NEAR(load.torque_nm.nominal, 9.24, 0.01);
  EXPECT_NEAR(load.thrust_n.nominal, 1584, 2);
  EXPECT_NEAR(load.power_w.nominal, 968, 1);
  EXPECT_NEAR(load.torque_nm.high, 9.24 * 1.3, 0.02);
}

/// With mc = 0 the power is kc times what is drilled out, whatever the edges and the point.
TEST(DrillingForce, PowerIsThatOfTheRemovalRate) {
  Material material = steel();
  material.mc = 0;
  for (const int edges : {1, 2, 3}) {
    const DrillingLoad load = drilling_load(material, {8, edges, 140, 0.15, 3000}, {});
    EXPECT_NEAR(load.power_w.nominal, 2000 * kPi / 4 * 64 * 0.15 * 50 / 1000, 1e-6);
  }
}

TEST(DrillingForce, NothingIsDrilledByNothing) {
  EXPECT_EQ(drilling_load(steel(), {10, 2, 118, 0, 1000}, {}).torque_nm.high, 0);
}

}  // namespace
}  // namespace kerf
