// Chips, forces, torque and power of milling, against closed forms.
#include "cutting/milling_force.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/cutting/edges_of.h"

namespace kerf {
namespace {

constexpr ValueRange kNoShare{0, 0, 0};

Material plain_material(double kc, double mc) {
  Material material;
  material.kc11_n_per_mm2 = {0.8 * kc, kc, 1.5 * kc};
  material.mc = mc;
  return material;
}

MillingCut cut_of(const CutArcAngles& arc, double feed_mm, double deep_mm, double rpm = 6000) {
  return {feed_mm, arc.entry_rad, arc.exit_rad, deep_mm, rpm};
}

TEST(MillingForce, ArcsAreThoseOfTheWidth) {
  const CutArcAngles slot = conventional_arc(5, 10), half = climb_arc(5, 5);
  EXPECT_DOUBLE_EQ(slot.entry_rad, 0);
  EXPECT_DOUBLE_EQ(slot.exit_rad, kPi);
  EXPECT_DOUBLE_EQ(half.entry_rad, kPi / 2);
  EXPECT_DOUBLE_EQ(half.exit_rad, kPi);
  // A tenth of the diameter: cos = 0.8.
  EXPECT_NEAR(conventional_arc(5, 1).exit_rad, 0.6435, 1e-4);
}

/// Thinned chips: 2 sqrt(a (1 - a)) of the feed where a = ae / D is below a half.
TEST(MillingForce, ChipsAreThinnerBesideTheMiddle) {
  const EdgeProfile flat = EdgeProfile::cylinder(5, 0.2);
  EXPECT_NEAR(chip_of(flat, cut_of(climb_arc(5, 10), 0.1, 3)).most_mm, 0.1, 1e-12);
  EXPECT_NEAR(chip_of(flat, cut_of(climb_arc(5, 10), 0.1, 3)).mean_mm, 0.1 * 2 / kPi, 1e-12);
  EXPECT_NEAR(chip_of(flat, cut_of(climb_arc(5, 1), 0.1, 3)).most_mm, 0.1 * 0.6, 1e-12);
  EXPECT_NEAR(chip_of(flat, cut_of(conventional_arc(5, 7), 0.1, 3)).most_mm, 0.1, 1e-12);
  // A ball of 10 mm, 0.1 mm deep: 1.99 mm wide, so sin(kappa) = 0.199.
  const EdgeProfile ball(ball_outline(5), 0.2);
  EXPECT_NEAR(chip_of(ball, cut_of({0, kPi}, 0.1, 0.1)).most_mm, 0.1 * 0.199, 2e-4);
  EXPECT_NEAR(cutting_speed_m_per_min(ball, cut_of({0, kPi}, 0.1, 0.1)), 2 * kPi * 0.995 * 6, 0.4);
}

/// With mc = 0 each mm3 takes the same: power = kc * Q, whatever the tool.
TEST(MillingForce, PowerIsThatOfTheRemovalRate) {
  const Material material = plain_material(1500, 0);
  const struct {
    EdgeProfile profile;
    double section_mm2;
  } cases[] = {{EdgeProfile::cylinder(5, 0), 3.0 * 4}};
  for (const auto& [profile, section_mm2] : cases) {
    for (const bool climb : {false, true}) {
      const MillingModel model(material, profile, {4, 0.5}, {});
      const CutArcAngles arc = climb ? climb_arc(5, 4) : conventional_arc(5, 4);
      const MillingLoad load = model.load_of(cut_of(arc, 0.05, 3));
      const double rate_mm3_per_s = section_mm2 * 0.05 * 4 * 100;
      EXPECT_NEAR(load.power_w.nominal, 1500 * rate_mm3_per_s / 1000, 0.05);
      EXPECT_NEAR(load.power_w.low, 0.8 * load.power_w.nominal, 1e-9);
      EXPECT_NEAR(load.power_w.high, 1.5 * load.power_w.nominal, 1e-9);
      EXPECT_NEAR(load.torque_mean_nm.nominal * 2 * kPi * 100, load.power_w.nominal, 1e-9);
    }
  }
}

/// A ball in a slot R deep: its section is pi/2 R^2.
TEST(MillingForce, PowerOfABallIsThatOfItsSection) {
  const MillingModel model(plain_material(1000, 0), EdgeProfile(ball_outline(4), 0), {2, 0.5}, {});
  const MillingLoad load = model.load_of(cut_of({0, kPi}, 0.1, 4));
  EXPECT_NEAR(load.power_w.nominal, 1000 * kPi / 2 * 16 * 0.1 * 2 * 100 / 1000, 0.2);
}

/// One straight tooth in a slot: kc * fz * ap straight ahead, 1/pi of it in the mean.
TEST(MillingForce, AStraightToothHasItsPeakAhead) {
  const EdgeProfile flat = EdgeProfile::cylinder(5, 0);
  const UnitForces unit =
      unit_forces(ChipIntegrals(0), flat, {1, 0}, cut_of({0, kPi}, 0.1, 3), kNoShare);
  EXPECT_NEAR(unit.tangential_most_n, 0.3, 1e-6);
  EXPECT_NEAR(unit.tangential_mean_n, 0.3 / kPi, 1e-6);
  EXPECT_NEAR(unit.torque_most_nm, 0.3 * 5 / 1000, 1e-8);
  // Of sin^2 the mean is a half: over half of the turn.
  EXPECT_NEAR(unit.sideways[1].normal_mean_n, 0.3 / 4, 1e-6);
  EXPECT_NEAR(unit.sideways[1].feed_mean_n, 0, 1e-6);
}

/// Four straight teeth in a slot: two are in material, and the forces along and across are the
/// same all round: kc fz ap across, the share of it against the feed.
TEST(MillingForce, FourTeethInASlotPushEvenly) {
  const EdgeProfile flat = EdgeProfile::cylinder(5, 0);
  const UnitForces unit = unit_forces(ChipIntegrals(0), flat, {4, 0}, cut_of({0, kPi}, 0.1, 3),
                                      ValueRange{0, 0.3, 0.6});
  const double whole = 0.1 * 3;
  EXPECT_NEAR(unit.sideways[0].most_n, whole, 1e-5);
  EXPECT_NEAR(unit.sideways[1].most_n, whole * std::hypot(1, 0.3), 1e-5);
  EXPECT_NEAR(unit.sideways[1].normal_mean_n, whole, 1e-5);
  EXPECT_NEAR(unit.sideways[1].feed_mean_n, -0.3 * whole, 1e-5);
}

/// A helix that lags by the whole pitch has the same torque all the time.
TEST(MillingForce, AFullPitchOfHelixIsSmooth) {
  const double radius = 5, deep = 8, pitch = 2 * kPi / 4;
  const double helix = std::atan(pitch * radius / deep);
  const EdgeProfile flat = EdgeProfile::cylinder(radius, 0.25);
  const UnitForces unit = unit_forces(ChipIntegrals(0.25), flat, {4, helix},
                                      cut_of(climb_arc(radius, 2), 0.05, deep), kNoShare);
  EXPECT_NEAR(unit.torque_most_nm, unit.torque_mean_nm, 1e-4 * unit.torque_mean_nm);
}

/// Kienzle by hand: fz 0.1, slot, one straight tooth, ap 3, kc11 1800, mc 0.25: at the peak
/// 1800 * 3 * 0.1^0.75 = 960 N.
TEST(MillingForce, ThinChipsTakeMoreForEachMm2) {
  const MillingModel model(plain_material(1800, 0.25), EdgeProfile::cylinder(5, 0.25), {1, 0}, {});
  const MillingLoad load = model.load_of(cut_of({0, kPi}, 0.1, 3));
  EXPECT_NEAR(load.tangential_n.nominal, 1800 * 3 * std::pow(0.1, 0.75), 0.5);
  const MillingLoad twice = model.load_of(cut_of({0, kPi}, 0.2, 3));
  EXPECT_NEAR(twice.tangential_n.nominal / load.tangential_n.nominal,
              std::pow(2, model.feed_exponent()), 1e-9);
  EXPECT_NEAR(twice.force_n.high / load.force_n.high, std::pow(2, 0.75), 1e-9);
}

/// Climb milling pushes the tool off the wall; a short conventional arc with little of the force
/// inwards draws it in.
TEST(MillingForce, ClimbMillingPushesOffTheWall) {
  const EdgeProfile flat = EdgeProfile::cylinder(5, 0.25);
  const ChipIntegrals integrals(0.25);
  const MillingEdges edges{4, 30 * kPi / 180};
  const UnitForces climb =
      unit_forces(integrals, flat, edges, cut_of(climb_arc(5, 1), 0.05, 6), {0.1, 0.3, 0.6});
  EXPECT_GT(climb.sideways[1].at_wall_n, 0);
  const UnitForces up =
      unit_forces(integrals, flat, edges, cut_of(conventional_arc(5, 4), 0.05, 6), {0.1, 0.3, 0.6});
  EXPECT_LT(up.sideways[0].at_wall_n, 0);
  // Wholly inside there is no wall.
  const UnitForces middle =
      unit_forces(integrals, flat, edges, cut_of({1, 2}, 0.05, 6), {0.1, 0.3, 0.6});
  EXPECT_EQ(middle.sideways[1].at_wall_n, 0);
}

TEST(MillingForce, RangesAreInOrder) {
  const Material material = plain_material(700, 0.27);
  const MillingModel model(material, EdgeProfile::cylinder(5, 0.27), {3, 0.5}, {});
  for (double wide = 0.2; wide <= 10; wide += 0.7) {
    for (const CutArcAngles& arc : {climb_arc(5, wide), conventional_arc(5, wide)}) {
      const MillingLoad load = model.load_of(cut_of(arc, 0.05, 4));
      for (const ValueRange& range :
           {load.force_n, load.tangential_n, load.torque_nm, load.torque_mean_nm, load.power_w,
            load.feed_force_n, load.normal_force_n, load.at_wall_n}) {
        EXPECT_LE(range.low, range.nominal) << wide;
        EXPECT_LE(range.nominal, range.high) << wide;
      }
      EXPECT_GE(load.torque_nm.nominal, load.torque_mean_nm.nominal * (1 - 1e-6)) << wide;
    }
  }
}

TEST(MillingForce, NothingIsCutByNothing) {
  const MillingModel model(plain_material(700, 0.27), EdgeProfile::cylinder(5, 0.27), {3, 0.5}, {});
  EXPECT_EQ(model.load_of({0.05, 1, 1, 4, 6000}).force_n.high, 0);
  EXPECT_EQ(model.load_of({0.05, 0, 1, 0, 6000}).force_n.high, 0);
  EXPECT_EQ(model.load_of({0, 0, 1, 4, 6000}).force_n.high, 0);
}

}  // namespace
}  // namespace kerf
