// What one tool cuts, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/stock/octree/octree_samples.h"

namespace kerf::test {
namespace {

/// Error of a volume must fall by about 4 when cells halve; 2.5 leaves room for luck.
void expect_second_order(double coarse, double fine, double scale) {
  EXPECT_LT(std::abs(fine), std::abs(coarse) / 2.5 + 1e-6 * scale)
      << "coarse " << coarse << " fine " << fine;
}

TEST(OctreeShape, BlankIsExact) {
  const auto tree = make_octree("box:-3,1,2:17.03,9.7,13.1", 0.5);
  EXPECT_NEAR(tree->blank_mm3(), 20.03 * 8.7 * 11.1, 1e-9);
  const HermiteGrid grid = whole(*tree);
  expect_sound(grid);
  const Box box = tree->bounds_mm();
  for (const SurfacePoint& p : surface_points(grid)) {
    int faces = 0;
    for (int a = 0; a < 3; ++a)
      faces += std::min(std::abs(p.at[a] - box.min[a]), std::abs(p.at[a] - box.max[a])) < 1e-5;
    ASSERT_EQ(faces, 1);
  }
}

TEST(OctreeShape, CylinderAndTubeVolume) {
  for (const char* axis : {"x", "y", "z"}) {
    double error[2];
    for (int fine = 0; fine < 2; ++fine) {
      const auto tree = make_octree(std::string("tube:1,2,3:23:16:7:") + axis, fine ? 0.25 : 0.5);
      const double length = 23 - (*axis == 'x' ? 1 : *axis == 'y' ? 2 : 3);
      error[fine] = tree->blank_mm3() - kPi * (64 - 12.25) * length;
      for (const SurfacePoint& p : surface_points(whole(*tree)))
        ASSERT_NEAR(glm::length(p.normal), 1, 1e-5);
    }
    expect_second_order(error[0], error[1], 3500);
    EXPECT_LT(std::abs(error[0]), 1.0) << axis;
  }
}

// What is above a plane, along the grid or under any angle to it: no direction is worse than
// others. The faces of the blank end it, so that edges are in it as well.
TEST(OctreeShape, VolumeAbovePlanesOfAnyDirection) {
  const double high = 3.217;
  for (const double cell : {1.0, 0.5}) {
    const double edges = 4 * cell * cell;  // what is left of O(cell^2): where planes meet
    for (int step = 0; step < 16; ++step) {
      const double angle = 0.1 * step;
      const Vec3 axis{std::sin(angle), 0, std::cos(angle)};
      const auto tree = make_octree("box:-10,-10,-10:10,10,10", cell);
      const double removed = removed_mm3(
          cut(*tree, make_cutter("flat:200"), {line(high * axis, high * axis, 0, axis)}));
      double expected = 0;
      constexpr int kParts = 4000;
      for (int i = 0; i < kParts; ++i) {
        const double x = -10 + 20 * (i + 0.5) / kParts;
        const double z = (high - x * std::sin(angle)) / std::cos(angle);
        expected += std::clamp(10 - z, 0.0, 20.0) * 20 * 20 / kParts;
      }
      EXPECT_NEAR(removed, expected, edges) << "angle " << angle << " cell " << cell;
    }
  }
}

// A lollipop on one spot takes away a whole ball (and its neck above).
TEST(OctreeShape, SphereVolumeAndNormals) {
  double error[2];
  for (int fine = 0; fine < 2; ++fine) {
    const auto tree = make_octree("box:-10,-10,-10:10,10,10", fine ? 0.25 : 0.5);
    const Cutter cutter = make_cutter("lollipop:12:4");
    const Vec3 centre{0.13, -0.21, -0.07};
    const Vec3 tip = centre - Vec3(0, 0, 6);
    const double removed = removed_mm3(cut(*tree, cutter, {line(tip, tip)}));
    // The neck from where it leaves the ball to the top of the blank.
    const double foot = std::sqrt(36.0 - 4.0), top = 10 - centre.z;
    const double cap = kPi * (6 - foot) * (6 - foot) * (18 - (6 - foot)) / 3;
    error[fine] = removed - (4.0 / 3 * kPi * 216 - cap + kPi * 4 * (top - foot));
    EXPECT_LT(std::abs(error[fine]), fine ? 0.01 : 0.05);
    const double cell = tree->cell_mm();
    for (const SurfacePoint& p : surface_points(whole(*tree))) {
      const Vec3 out = p.at - centre;
      const bool on_ball = std::abs(glm::length(out) - 6) < 1e-3 * cell &&
                           !(out.z > 0 && std::hypot(out.x, out.y) < 2.01);
      if (on_ball) {
        ASSERT_GT(glm::dot(p.normal, -glm::normalize(out)), std::cos(0.1 * kPi / 180));
      }
    }
  }
}

// Ball nose on a ramp: what is below the centre line's height sweeps a capsule; the blank ends
// there.
TEST(OctreeShape, HorizontalCapsuleVolumeConvergesWithSecondOrder) {
  double error[3];
  for (int level = 0; level < 3; ++level) {
    const auto tree = make_octree("box:-12,-9,-8:22,9,0", 1.0 / (1 << level));
    const Cutter cutter = make_cutter("ball:10");
    const double removed =
        removed_mm3(cut(*tree, cutter, {line({0.1, 0.03, -5.5}, {10.1, 1.03, -5.5})}));
    const double length = std::hypot(10, 1);
    // Half a capsule, and half a millimetre of its outline above it.
    const double half = kPi * 25 / 2 * length + 2.0 / 3 * kPi * 125;
    const double outline = 0.5 * (10 * length + kPi * 25);
    error[level] = removed - half - outline;
  }
  expect_second_order(error[0], error[1], 1000);
  expect_second_order(error[1], error[2], 1000);
}

TEST(OctreeShape, PocketWallsAndFloorAreExact) {
  const auto tree = make_octree("box:0,0,-10:30,30,0", 0.5);
  const Cutter cutter = make_cutter("flat:6");
  cut(*tree, cutter,
      {line({8.1, 8.2, -3.3}, {20.3, 8.2, -3.3}), line({20.3, 8.2, -3.3}, {20.3, 19.7, -3.3}),
       line({20.3, 19.7, -3.3}, {8.1, 19.7, -3.3}), line({8.1, 19.7, -3.3}, {8.1, 8.2, -3.3}),
       line({8.1, 8.2, -3.3}, {20.3, 19.7, -3.3})});
  int floor = 0, walls = 0;
  for (const SurfacePoint& p : surface_points(whole(*tree))) {
    const bool inside =
        p.at.x > 5 && p.at.x < 24 && p.at.y > 5 && p.at.y < 23 && p.at.z < -1e-3 && p.at.z > -9;
    if (!inside) continue;
    if (p.normal.z > 0.9) {
      ++floor;
      ASSERT_NEAR(p.at.z, -3.3, 1e-5);
    } else if (p.normal.x > 0.999 && p.at.x < 6 && p.at.y > 9 && p.at.y < 19) {
      ++walls;
      ASSERT_NEAR(p.at.x, 5.1, 1e-5);
    }
  }
  EXPECT_GT(floor, 500);
  EXPECT_GT(walls, 50);
}

// Straight through a block under an angle: the slot's walls and floor in the tool's own frame.
TEST(OctreeShape, TiltedSlotIsExact) {
  const auto tree = make_octree("box:-15,-15,-12:15,15,0", 0.5);
  const double tilt = 0.5;
  const Vec3 axis{0, std::sin(tilt), std::cos(tilt)};
  const Cutter cutter = make_cutter("flat:8");
  const Vec3 from{-30, 0.3, -5.1}, to{30, 0.3, -5.1};
  cut(*tree, cutter, {line(from, to, 0, axis)});
  const Vec3 across = glm::cross(axis, Vec3(1, 0, 0));
  int floor = 0, walls = 0;
  for (const SurfacePoint& p : surface_points(whole(*tree))) {
    const bool on_blank = std::abs(std::abs(p.at.x) - 15) < 1e-4 ||
                          std::abs(std::abs(p.at.y) - 15) < 1e-4 || p.at.z > -1e-4 ||
                          p.at.z < -12 + 1e-4;
    if (on_blank) continue;
    const double up = glm::dot(p.at - from, axis), side = glm::dot(p.at - from, across);
    if (std::abs(up) < 1e-4) {
      ++floor;
      ASSERT_GT(glm::dot(p.normal, axis), 0.99999);
    } else {
      ++walls;
      ASSERT_NEAR(std::abs(side), 4, 1e-4);
      ASSERT_GT(glm::dot(p.normal, side > 0 ? -across : across), 0.99999);
    }
  }
  EXPECT_GT(floor, 500);
  EXPECT_GT(walls, 500);
}

TEST(OctreeShape, UndercutVolumes) {
  struct Case {
    const char* shape;
    double area;  ///< of the cross-section, neck up to z = 0 included; tip at -8
  };
  const double lollipop = kPi * 9 - (9 * std::asin(1.0 / 3) - std::sqrt(8.0));
  for (const Case& c : {Case{"tslot:10:3:4", 10 * 3 + 4 * 5.0},
                        Case{"lollipop:6:2", lollipop + 2 * (5 - std::sqrt(8.0))},
                        Case{"dovetail:10:60:4",
                             (10 + 4) / 2.0 * 3 * std::sqrt(3.0) + 4 * (8 - 3 * std::sqrt(3.0))}}) {
    const auto tree = make_octree("box:0,0,-12:20,24,0", 0.2);
    const double removed =
        removed_mm3(cut(*tree, make_cutter(c.shape), {line({-20, 12.04, -8}, {40, 12.04, -8})}));
    EXPECT_NEAR(removed, c.area * 20, 0.01 * c.area * 20) << c.shape;
    const HermiteGrid grid = whole(*tree);
    expect_sound(grid);
    const auto at = [&](double y, double z) {
      const Vec3 n = (Vec3(10, y, z) - grid.origin_mm) / grid.cell_mm;
      const int i = static_cast<int>(n.x), j = static_cast<int>(n.y), k = static_cast<int>(n.z);
      return grid.solid[static_cast<std::size_t>((k * grid.nodes[1] + j) * grid.nodes[0] + i)] != 0;
    };
    EXPECT_TRUE(at(14.6, -1)) << c.shape << ": the roof of the slot";
    EXPECT_FALSE(at(12, -1)) << c.shape << ": the neck";
    EXPECT_FALSE(at(14.3, -6.5)) << c.shape << ": beside the neck";
  }
}

// Full circle: a ring, closed forms of torus and walls.
TEST(OctreeShape, LevelArcIsExact) {
  const auto tree = make_octree("box:-20,-20,-8:20,20,0", 0.5);
  const Cutter cutter = make_cutter("flat:6");
  CutMove move = line({10, 0, -4.2}, {10, 0, -4.2});
  move.arc = CutArc{{0, 0, -4.2}, {0, 0, 1}, 2 * kPi};
  const double removed = removed_mm3(cut(*tree, cutter, {move}));
  EXPECT_NEAR(removed, kPi * (13 * 13 - 7 * 7) * 4.2, 2.0);
  for (const SurfacePoint& p : surface_points(whole(*tree))) {
    if (p.at.z > -1e-3 || p.at.z < -4.1) continue;
    const double r = std::hypot(p.at.x, p.at.y);
    if (r > 14) continue;
    ASSERT_LT(std::min(std::abs(r - 7), std::abs(r - 13)), 2e-5);
  }
}

TEST(OctreeShape, ReportsHeightOfWhatIsRemoved) {
  const auto tree = make_octree("box:0,0,-20:40,40,0", 0.5);
  const Cutter cutter = make_cutter("flat:10");
  const auto reports =
      cut(*tree, cutter,
          {line({10, 20, 5}, {10, 20, -3.3}, 7), line({10, 20, -3.3}, {30, 20, -3.3}, 8),
           line({30, 20, -3.3}, {30, 20, -9.1}, 9), line({30, 20, 5}, {30, 20, 30}, 10)});
  ASSERT_EQ(reports.size(), 4u);
  EXPECT_EQ(reports[0].id, 7u);
  EXPECT_NEAR(reports[0].depth_mm, 3.3, 1e-3);
  EXPECT_NEAR(reports[0].removed_mm3, kPi * 25 * 3.3, 1.5);
  EXPECT_NEAR(reports[1].depth_mm, 3.3, 1e-3);
  EXPECT_NEAR(reports[1].removed_mm3, 20 * 10 * 3.3, 1.5);
  EXPECT_NEAR(reports[2].depth_mm, 5.8, 1e-3);
  EXPECT_EQ(reports[3].removed_mm3, 0);
  EXPECT_NEAR(tree->blank_mm3() - tree->remaining_mm3(), removed_mm3(reports), 1e-6);
}

}  // namespace
}  // namespace kerf::test
