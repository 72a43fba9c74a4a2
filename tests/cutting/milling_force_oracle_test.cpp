// The same by brute force: each slice of each tooth at each of many angles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "cutting/milling_force.h"
#include "tests/cutting/edges_of.h"

namespace kerf {
namespace {

struct Oracle {
  double tangential_mean = 0, tangential_most = 0, torque_mean = 0, torque_most = 0;
  double feed_mean = 0, normal_mean = 0, most = 0;
};

/// Forces of `slices` slices of the outline up to `cut.deep_mm` and `turns` places of one pitch.
Oracle brute_force(const std::vector<Vec2>& outline, double mc, const MillingEdges& edges,
                   const MillingCut& cut, double share, int slices, int turns) {
  const double radius = outline.back().x, pitch = 2 * kPi / edges.teeth;
  std::vector<Vec2> edge;  // radius and sin(kappa) of each slice
  for (int k = 0; k < slices; ++k) {
    const double z = (k + 0.5) * cut.deep_mm / slices;
    edge.emplace_back(radius, 1);
    for (std::size_t n = 0; n + 1 < outline.size(); ++n) {
      const Vec2 a = outline[n], b = outline[n + 1];
      if (z < a.y || z >= b.y) continue;
      edge.back() = {a.x + (b.x - a.x) * (z - a.y) / (b.y - a.y),
                     (b.y - a.y) / std::hypot(b.y - a.y, b.x - a.x)};
    }
  }
  Oracle out;
  for (int t = 0; t < turns; ++t) {
    double tangential = 0, torque = 0, along = 0, across = 0;
    for (int k = 0; k < slices; ++k) {
      const double high = cut.deep_mm / slices, z = (k + 0.5) * high;
      const double r = edge[static_cast<std::size_t>(k)].x;
      const double steep = edge[static_cast<std::size_t>(k)].y;
      for (int tooth = 0; tooth < edges.teeth; ++tooth) {
        double phi = pitch * t / turns + pitch * tooth - z * std::tan(edges.helix_rad) / radius;
        phi -= std::floor(phi / (2 * kPi)) * 2 * kPi;
        if (phi < cut.entry_rad || phi > cut.exit_rad) continue;
        const double chip = cut.feed_per_tooth_mm * std::sin(phi) * steep;
        if (chip <= 0) continue;
        const double force = std::pow(chip, 1 - mc) * high / steep;
        tangential += force;
        torque += force * r / 1000;
        const double inward = share * force * steep;
        along += -force * std::cos(phi) - inward * std::sin(phi);
        across += force * std::sin(phi) - inward * std::cos(phi);
      }
    }
    out.tangential_mean += tangential / turns;
    out.torque_mean += torque / turns;
    out.feed_mean += along / turns;
    out.normal_mean += across / turns;
    out.tangential_most = std::max(out.tangential_most, tangential);
    out.torque_most = std::max(out.torque_most, torque);
    out.most = std::max(out.most, std::hypot(along, across));
  }
  return out;
}

/// Means at 1e5 angles are exact; flat cutters need one slice where the helix is 0.
TEST(MillingForceOracle, MeansAtAHundredThousandAngles) {
  for (const double mc : {0.0, 0.2, 0.5}) {
    const ChipIntegrals integrals(mc);
    for (const MillingCut& cut :
         {MillingCut{0.1, 0, kPi, 3, 1000}, MillingCut{0.05, 0, 0.6, 2, 1000},
          MillingCut{0.05, 2.7, kPi, 2, 1000}}) {
      const EdgeProfile flat = EdgeProfile::cylinder(5, mc);
      const MillingEdges edges{3, 0};
      const UnitForces unit = unit_forces(integrals, flat, edges, cut, {0.3, 0.3, 0.3});
      const Oracle oracle = brute_force({{0, 0}, {5, 0}}, mc, edges, cut, 0.3, 1, 100'000);
      EXPECT_NEAR(unit.tangential_mean_n, oracle.tangential_mean, 1e-4 * oracle.tangential_mean);
      EXPECT_NEAR(unit.torque_mean_nm, oracle.torque_mean, 1e-4 * oracle.torque_mean);
      EXPECT_NEAR(unit.sideways[1].feed_mean_n, oracle.feed_mean, 1e-4 * oracle.tangential_mean);
      EXPECT_NEAR(unit.sideways[1].normal_mean_n, oracle.normal_mean,
                  1e-4 * oracle.tangential_mean);
      EXPECT_NEAR(unit.tangential_most_n, oracle.tangential_most, 0.01 * oracle.tangential_most);
      EXPECT_NEAR(unit.sideways[1].most_n, oracle.most, 0.01 * oracle.most);
    }
  }
}

struct Bounds {
  double mean = 0, most = 0;
};

/// Random cuts with a helix: the worst deviations, of the tangential mean and peak.
Bounds worst_of(const std::vector<Vec2>& outline, unsigned seed, double most_deep_mm) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Bounds worst;
  for (int n = 0; n < 60; ++n) {
    const double mc = 0.35 * unit(random);
    const MillingEdges edges{1 + static_cast<int>(6 * unit(random)), kPi / 4 * unit(random)};
    MillingCut cut;
    cut.feed_per_tooth_mm = 0.01 + 0.2 * unit(random);
    cut.deep_mm = most_deep_mm * (0.02 + 0.98 * unit(random));
    const double arc = 0.3 + (kPi - 0.3) * unit(random), place = unit(random);
    cut.entry_rad = place < 0.4 ? 0 : place < 0.8 ? kPi - arc : (kPi - arc) * unit(random);
    cut.exit_rad = cut.entry_rad + arc;
    cut.rpm = 5000;
    const EdgeProfile profile(outline, mc);
    const UnitForces forces = unit_forces(ChipIntegrals(mc), profile, edges, cut, {0.3, 0.3, 0.3});
    const Oracle oracle = brute_force(outline, mc, edges, cut, 0.3, 120, 360);
    const auto off = [](double a, double b) { return std::abs(a - b) / std::max(b, 1e-12); };
    worst.mean = std::max({worst.mean, off(forces.tangential_mean_n, oracle.tangential_mean),
                           off(forces.torque_mean_nm, oracle.torque_mean)});
    worst.most = std::max({worst.most, off(forces.tangential_most_n, oracle.tangential_most),
                           off(forces.torque_most_nm, oracle.torque_most),
                           off(forces.sideways[1].most_n, oracle.most)});
  }
  return worst;
}

TEST(MillingForceOracle, FlatCutters) {
  const Bounds worst = worst_of({{0, 0}, {5, 0}}, 1, 12);
  EXPECT_LT(worst.mean, 0.01);
  EXPECT_LT(worst.most, 0.03);
  std::cout << "flat: means within " << worst.mean << ", peaks " << worst.most << "\n";
}

TEST(MillingForceOracle, BullNoses) {
  const Bounds worst = worst_of(bull_outline(5, 1.5), 2, 8);
  EXPECT_LT(worst.mean, 0.01);
  EXPECT_LT(worst.most, 0.03);
  std::cout << "bull: means within " << worst.mean << ", peaks " << worst.most << "\n";
}

TEST(MillingForceOracle, Balls) {
  const Bounds worst = worst_of(ball_outline(5), 3, 6);
  EXPECT_LT(worst.mean, 0.015);
  EXPECT_LT(worst.most, 0.03);
  std::cout << "ball: means within " << worst.mean << ", peaks " << worst.most << "\n";
}

TEST(MillingForceOracle, Cones) {
  const Bounds worst = worst_of(vee_outline(5, kPi / 6), 4, 8);
  EXPECT_LT(worst.mean, 0.01);
  EXPECT_LT(worst.most, 0.03);
  std::cout << "cone: means within " << worst.mean << ", peaks " << worst.most << "\n";
}

}  // namespace
}  // namespace kerf
