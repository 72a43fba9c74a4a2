#include "twin/collision/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace kerf {
namespace {

SolidPointer cylinder(double radius, double low, double high) {
  const std::vector<std::vector<RoundedDisc>> hulls{{{radius, low, 0}, {radius, high, 0}}};
  return Solid::of_hulls(hulls);
}

SolidPointer solid_of(std::string_view spec) {
  return Solid::of_bodies(parse_blank(spec).value().bodies);
}

std::optional<double> touch(const SolidPointer& tool, const CutMove& move,
                            const SolidPointer& still) {
  Vec3 guess{0};
  return first_touch(tool->pieces()[0], ToolWay(move), *still, guess);
}

std::optional<LeastGap> least(const SolidPointer& tool, const CutMove& move,
                              const SolidPointer& still, double below = 1e9) {
  Vec3 guess{0};
  return least_gap(tool->pieces()[0], ToolWay(move), *still, below, below, guess);
}

CutMove straight(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

TEST(Sweep, AStraightMoveTouchesWhereItMeetsTheFace) {
  const auto tool = cylinder(5, 0, 50);
  const auto block = solid_of("box:20,-10,-10:40,10,10");
  const auto met = touch(tool, straight({-85, 0, 0}, {115, 0, 0}), block);
  ASSERT_TRUE(met);
  EXPECT_NEAR(-85 + 200 * *met, 15, kWayExact_mm);
  EXPECT_FALSE(touch(tool, straight({-85, 15.01, 0}, {115, 15.01, 0}), block));
  EXPECT_FALSE(touch(tool, straight({-85, 0, 10.01}, {115, 0, 10.01}), block));
}

TEST(Sweep, AnArcTouchesWhereTheCirclesMeet) {
  // Round 0,0 at 30 mm; a post of 4 mm at 30,0 turned by 50 degrees: centres are 2 + 3 apart.
  const auto tool = cylinder(3, 0, 20);
  const double angle = 50 * kPi / 180;
  const auto post = Solid::of_bodies(std::vector{[&] {
    BlankBody body;
    body.kind = BlankBody::Kind::kCylinder;
    body.diameter_mm = 4;
    body.center_mm = {30 * std::cos(angle), 30 * std::sin(angle), 0};
    body.bounds_mm.extend(body.center_mm - Vec3{2, 2, 5});
    body.bounds_mm.extend(body.center_mm + Vec3{2, 2, 5});
    return body;
  }()});
  CutMove move = straight({30, 0, 0}, {-30, 0, 0});
  move.arc = CutArc{{0, 0, 0}, {0, 0, 1}, kPi};
  const auto met = touch(tool, move, post);
  ASSERT_TRUE(met);
  const double expected = angle - 2 * std::asin(5.0 / 2 / 30);
  EXPECT_NEAR(*met * kPi * 30, expected * 30, 2 * kWayExact_mm);
  // Past it on the outside: nearest at 50 degrees.
  move.from_mm = {36, 0, 0};
  move.to_mm = {-36, 0, 0};
  const auto near = least(tool, move, post);
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->mm, 1, 1e-3);
  EXPECT_NEAR(near->t * kPi, angle, 0.02);
  EXPECT_FALSE(touch(tool, move, post));
}

TEST(Sweep, AHelixOfManyTurnsTouchesOnItsLastOne) {
  const auto tool = cylinder(3, 0, 20);
  CutMove move = straight({10, 0, 30}, {10, 0, 0});
  move.arc = CutArc{{0, 0, 0}, {0, 0, 1}, 20 * kPi};
  const auto bed = solid_of("box:-50,-50,-10:50,50,0.75");
  const auto met = touch(tool, move, bed);
  ASSERT_TRUE(met);
  EXPECT_NEAR(30 * (1 - *met), 0.75, 0.001);
}

TEST(Sweep, ATiltingToolTouchesWithItsFlank) {
  // The tip stays at 0; the axis leans from upright by 40 degrees towards +X, beside a wall at X20
  // whose top is at Z30. A line of no width through 0 at an angle a meets the edge at
  // tan(a) = 20/30; a rod of 2 mm earlier, by asin(2 / |edge|).
  const auto tool = cylinder(2, 0, 100);
  CutMove move;
  move.axis_to = {std::sin(40 * kPi / 180), 0, std::cos(40 * kPi / 180)};
  const auto wall = solid_of("box:20,-10,0:30,10,30");
  const auto met = touch(tool, move, wall);
  ASSERT_TRUE(met);
  const double expected = std::atan2(20, 30) - std::asin(2 / std::hypot(20, 30));
  EXPECT_NEAR(*met * 40 * kPi / 180, expected, 1e-4);
}

TEST(Sweep, TubesAndMeshesEnclose) {
  const auto rod = cylinder(2, 0, 10);
  const auto tube = solid_of("tube:0,0,0:20:60:40");
  EXPECT_NEAR(least(rod, straight({-15, 0, 5}, {15, 0, 5}), tube)->mm, 3, 0.003);
  EXPECT_NEAR(least(rod, straight({40, 0, 5}, {41, 0, 5}), tube)->mm, 8, 0.003);
  EXPECT_NEAR(*touch(rod, straight({0, 0, 5}, {40, 0, 5}), tube) * 40, 18, 0.006);
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions_mm.emplace_back((i & 1) * 10, (i >> 1 & 1) * 10, (i >> 2 & 1) * 10);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const auto cube = Solid::of_mesh(mesh);
  EXPECT_TRUE(cube->is_closed());
  EXPECT_TRUE(cube->encloses({5, 5, 5}));
  EXPECT_FALSE(cube->encloses({5, 5, 10.5}));
  EXPECT_FALSE(cube->encloses({-1, 5, 5}));
  const auto pin = cylinder(1, 0, 2);
  EXPECT_EQ(touch(pin, straight({5, 5, 4}, {5, 5, 5}), cube), 0);
  mesh.triangles.pop_back();
  EXPECT_FALSE(Solid::of_mesh(mesh)->is_closed());
}

TEST(Sweep, DepthIsWhatWouldHaveToBeThinner) {
  const auto tool = cylinder(5, 0, 50);
  const auto block = solid_of("box:20,-10,-10:40,10,10");
  const CutMove move = straight({-20, 14.5, 0}, {80, 14.5, 0});
  EXPECT_NEAR(touch_depth_mm(tool->pieces()[0], ToolWay(move), *block), 0.5, 0.01);
  const CutMove over = straight({-20, 0, 9.98}, {80, 0, 9.98});
  EXPECT_NEAR(touch_depth_mm(tool->pieces()[0], ToolWay(over), *block), 0.02, 0.01);
}

/// By steps of a hundredth of a millimetre and less.
TEST(Sweep, RandomMovesAreAsNearAsTheirSteps) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto tool = cylinder(4, 0, 25);
  const auto still = solid_of("box:-10,-8,-6:10,8,6+cylinder:20,0,-6:15:8");
  int touched = 0;
  for (int i = 0; i < 60; ++i) {
    CutMove move = straight(30.0 * Vec3{unit(random), unit(random), unit(random)},
                            30.0 * Vec3{unit(random), unit(random), unit(random)});
    if (i % 3 == 1) {
      move.arc = CutArc{15.0 * Vec3{unit(random), unit(random), 0}, {0, 0, 1}, 6 * unit(random)};
    } else if (i % 3 == 2) {
      move.axis_from = glm::normalize(Vec3{unit(random), unit(random), 1.5});
      move.axis_to = glm::normalize(Vec3{unit(random), unit(random), 1.5});
    }
    const ToolWay way(move);
    constexpr int kSteps = 4000;
    double brute = 1e9, first = -1;
    for (int k = 0; k <= kSteps; ++k) {
      const Pose pose = way.pose(static_cast<double>(k) / kSteps);
      double near = 1e9;
      for (const Convex& piece : still->pieces())
        near = std::min(near, gap_of({tool->pieces()[0], pose, pose}, piece, 1e9, 1e-5).low_mm);
      if (near <= 0 && first < 0) first = static_cast<double>(k) / kSteps;
      brute = std::min(brute, near);
    }
    const double step_mm = way.travel_mm(0, 1, 30) / kSteps;
    const auto near = least(tool, move, still);
    ASSERT_TRUE(near) << i;
    EXPECT_LE(near->mm, brute + 1e-3) << i;
    EXPECT_GE(near->mm, brute - step_mm - 1e-3) << i;
    // Nobody asks to know more than 0 exactly: up to a tenth less. As exactly as before, up to
    // more.
    Vec3 guess{0};
    const auto coarse = least_gap(tool->pieces()[0], way, *still, 1e9, 0, guess);
    EXPECT_LE(coarse->mm, near->mm + 1e-3) << i;
    EXPECT_GE(coarse->mm, near->mm - 0.1 - 1e-3) << i;
    const auto exact = least_gap(tool->pieces()[0], way, *still, 1e9, near->mm + 0.5, guess);
    EXPECT_NEAR(exact->mm, near->mm, kWayExact_mm) << i;
    const auto met = touch(tool, move, still);
    if (first >= 0) {
      ASSERT_TRUE(met) << i;
      ++touched;
      EXPECT_LE(*met, first + 1e-6) << i;
      EXPECT_GE(*met, first - 1.0 / kSteps - kWayExact_mm / way.travel_mm(0, 1, 30) - 1e-6) << i;
    } else if (brute > step_mm) {
      EXPECT_FALSE(met) << i;
    }
  }
  EXPECT_GT(touched, 15);
}

}  // namespace
}  // namespace kerf
