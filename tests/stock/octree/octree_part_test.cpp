// Shank and holder against an octree: closed forms, and an oracle that steps along the way and
// keeps a cloud of points as the cutter leaves it.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "stock/cutter/cutting_shank.h"
#include "tests/stock/octree/octree_samples.h"

namespace kerf::test {
namespace {

constexpr double kTolerance_mm = 0.01;

Vec3 tilted(double rad, double about_z = 0) {
  return {std::sin(rad) * std::cos(about_z), std::sin(rad) * std::sin(about_z), std::cos(rad)};
}

std::optional<PartContact> contact(const Octree& tree, const char* shape, const CarriedPart& part,
                                   const CutMove& move) {
  return tree.part_contact(make_cutter(shape), part, move, kTolerance_mm);
}

TEST(OctreePart, AnUprightHolderIsToldToTheHundredth) {
  for (const double cell : {0.4, 1.0}) {
    const auto tree = make_octree("box:0,0,-20:30,30,0", cell);
    const CarriedPart holder{16, 12};
    const auto met = contact(*tree, "flat:6:flute=12", holder, line({15, 15, 2}, {15, 15, -13}));
    ASSERT_TRUE(met);
    EXPECT_NEAR(met->tip_mm.z, -12, 0.011);
    EXPECT_NEAR(met->depth_mm, 1, 0.001);
    EXPECT_FALSE(contact(*tree, "flat:6:flute=12", holder, line({15, 15, 2}, {15, 15, -11.995})));
    EXPECT_TRUE(contact(*tree, "flat:6:flute=12", holder, line({15, 15, 2}, {15, 15, -12.02})));
    // A shank no wider than the cutter is in the hole that is cut.
    EXPECT_FALSE(contact(*tree, "flat:6:flute=12", {3, 12}, line({15, 15, 2}, {15, 15, -18})));
  }
}

TEST(OctreePart, ATiltedHolderMeetsTheTopWithItsRim) {
  const auto tree = make_octree("box:0,0,-20:60,60,0", 1);
  for (const double tilt : {0.2, 0.5, 0.9}) {
    const double radius = 16, height = 45;
    // The lowest place of the rim is so far above the tip.
    const double rim = height * std::cos(tilt) - radius * std::sin(tilt);
    const Vec3 axis = tilted(tilt);
    const auto across = [&](double gap) {
      return line({2, 10, gap - rim}, {2, 40, gap - rim}, 0, axis);
    };
    EXPECT_TRUE(contact(*tree, "ball:6", {radius, height, height + 30}, across(-0.025))) << tilt;
    EXPECT_FALSE(contact(*tree, "ball:6", {radius, height, height + 30}, across(0.02))) << tilt;
    const auto met = contact(*tree, "ball:6", {radius, height, height + 30}, across(-1));
    ASSERT_TRUE(met);
    // So much farther up the spindle the rim would be at the top.
    EXPECT_NEAR(met->depth_mm, 1 / std::cos(tilt), 0.05) << tilt;
    EXPECT_NEAR(met->t, 0, 1e-3);
  }
}

TEST(OctreePart, ATurningSpindleBringsTheHolderDown) {
  const auto tree = make_octree("box:0,0,-30:60,60,0", 1);
  const double radius = 20, height = 40;
  CutMove move = line({-15, 30, -10}, {-15, 30, -10});
  move.axis_to = tilted(1.2);
  // height * cos - radius * sin = 10, where the rim comes to the top.
  const double at = std::acos(10 / std::hypot(height, radius)) - std::atan2(radius, height);
  const auto met = contact(*tree, "ball:6", {radius, height, height + 20}, move);
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->t, at / 1.2, 0.002);
  move.axis_to = tilted(at - 0.002);
  EXPECT_FALSE(contact(*tree, "ball:6", {radius, height, height + 20}, move));
}

TEST(OctreePart, AHolderEnds) {
  // Above its top there is nothing: a wall that leans over it is not met.
  const auto tree = make_octree("box:0,0,0:10,40,60+box:0,0,50:40,40,60", 0.5);
  const CutMove along = line({25, 10, 5}, {25, 30, 5});
  EXPECT_FALSE(contact(*tree, "ball:4:flute=10", {10, 20, 44}, along));
  EXPECT_TRUE(contact(*tree, "ball:4:flute=10", {10, 20, 46}, along));
  EXPECT_TRUE(contact(*tree, "ball:4:flute=10", {10, 20}, along));
  // Its upper end is 1 mm in the wall above; a holder that is higher is so all the more.
  const auto deep = contact(*tree, "ball:4:flute=10", {10, 20, 46}, along);
  EXPECT_NEAR(deep->depth_mm, 35, 0.01);
  const auto gap = tree->part_gap(make_cutter("ball:4:flute=10"), {10, 20, 44.4}, along, 2);
  ASSERT_TRUE(gap);
  EXPECT_NEAR(gap->mm, 0.6, 1e-3);
}

TEST(OctreePart, AnArcBringsTheHolderToAWall) {
  const auto tree = make_octree("box:0,0,-40:10,60,0", 0.5);
  CutMove move = line({40, 10, -30}, {40, 50, -30});
  CutArc arc;
  arc.center_mm = {40, 30, -30};
  arc.axis = {0, 0, -1};
  arc.sweep_rad = kPi;
  move.arc = arc;  // by way of X20: the holder reaches to 20 - radius
  EXPECT_FALSE(contact(*tree, "ball:6", {9.98, 20, 50}, move));
  const auto met = contact(*tree, "ball:6", {10.03, 20, 50}, move);
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->t, 0.5, 0.05);
  const auto gap = tree->part_gap(make_cutter("ball:6"), {9.5, 20, 50}, move, 1);
  ASSERT_TRUE(gap);
  EXPECT_NEAR(gap->mm, 0.5, 0.01);
  EXPECT_NEAR(gap->t, 0.5, 0.03);
}

TEST(OctreePart, FlutesThatAreTooShortLeaveWhatTheShankRubs) {
  const auto tree = make_octree("box:0,0,-20:30,30,0", 0.5);
  const auto met = contact(*tree, "flat:6:flute=8", {3, 8}, line({-10, 15, -10}, {40, 15, -10}));
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->depth_mm, 2, 0.01);
  EXPECT_NEAR(met->tip_mm.x, -3, 0.3);
  EXPECT_FALSE(contact(*tree, "flat:6:flute=8", {3, 8}, line({-10, 15, -8}, {40, 15, -8})));
  // Tilted, in two steps: the second one has the wall of the first above its flutes.
  const Vec3 axis = tilted(0.4, 1.1);
  const CutMove first = line({-10, 15, -4}, {40, 15, -4}, 0, axis);
  CutMove second = first;
  second.from_mm -= 4.0 * axis;
  second.to_mm -= 4.0 * axis;
  EXPECT_TRUE(contact(*tree, "flat:6:flute=6", {3, 6}, second));
  cut(*tree, make_cutter("flat:6:flute=6"), {first});
  EXPECT_FALSE(contact(*tree, "flat:6:flute=6", {3, 6}, second));
}

TEST(OctreePart, AShankThatCutsLeavesRoomForItself) {
  // A tilted plunge into the block, by a cutter whose shank is wider; then the same again.
  const Cutter cutter = make_cutter("flat:4:flute=6:shank=8");
  const std::optional<Cutter> cutting = with_cutting_shank(cutter);
  ASSERT_TRUE(cutting);
  const Vec3 axis = tilted(0.5, 2);
  const CutMove down = line(Vec3(15, 15, 0) + 12.0 * axis, Vec3(15, 15, 0) - 9.0 * axis, 0, axis);
  const auto tree = make_octree("box:0,0,-20:30,30,0", 0.5);
  const CarriedPart shank{4, 6};
  const auto met = tree->part_contact(cutter, shank, down, kTolerance_mm);
  ASSERT_TRUE(met);
  // Where the axis goes in the shank is 3 mm deep; at its rim, 4 mm from it, 4 tan 0.5 more.
  EXPECT_NEAR(met->depth_mm, 3 + 4 * std::tan(0.5), 0.1);
  cut(*tree, cutter, {down});
  EXPECT_TRUE(tree->part_contact(cutter, shank, down, kTolerance_mm));
  cut(*tree, *cutting, {down});
  EXPECT_FALSE(tree->part_contact(cutter, shank, down, kTolerance_mm));
  // Cylinders cut off by the top: as long as along the axis.
  EXPECT_NEAR(tree->blank_mm3() - tree->remaining_mm3(), kPi * 4 * 9 + kPi * (16 - 4) * 3, 1.5);
}

TEST(OctreePart, SpareIsNeverMoreThanTheDistance) {
  const auto tree = make_octree("box:0,0,-20:30,30,0", 0.5);
  for (const double gap : {0.3, 1.0, 2.0, 4.0, 9.0, 14.0}) {
    const Vec3 tip{15, 15, gap - 12};
    const double spare = tree->part_spare_mm({10, 12}, line(tip, tip), 1, 5);
    // By bricks, half of whose diagonal is 3.5 mm on either side.
    EXPECT_LE(spare, std::min(gap, 5.0));
    EXPECT_GE(spare, std::min(gap - 8, 5.0));
  }
}

/// Points of the block, and which of them are there still.
struct Cloud {
  std::vector<Vec3> points;
  void cut(const Cutter& cutter, const CutMove& move, double up_to_mm, int steps);
};

struct Pose {
  Vec3 tip, axis;
};

Pose pose_at(const CutMove& move, double t) {
  const Vec3 tip = move.from_mm + t * (move.to_mm - move.from_mm);
  const double turn = std::acos(std::clamp(glm::dot(move.axis_from, move.axis_to), -1.0, 1.0));
  if (turn < 1e-9) return {tip, move.axis_from};
  return {tip, (std::sin((1 - t) * turn) * move.axis_from + std::sin(t * turn) * move.axis_to) /
                   std::sin(turn)};
}

/// (distance from the axis, height above the tip).
Vec2 seen_from(const Pose& pose, const Vec3& p) {
  const double z = glm::dot(p - pose.tip, pose.axis);
  return {glm::length(p - pose.tip - z * pose.axis), z};
}

bool in_flutes(const Cutter& cutter, const Vec2& at, double up_to_mm, double slack) {
  return at.y <= up_to_mm + slack && in_cutter(cutter, at.x, at.y, -slack);
}

void Cloud::cut(const Cutter& cutter, const CutMove& move, double up_to_mm, int steps) {
  for (int s = 0; s <= steps; ++s) {
    const Pose pose = pose_at(move, static_cast<double>(s) / steps);
    std::erase_if(
        points, [&](const Vec3& p) { return in_flutes(cutter, seen_from(pose, p), up_to_mm, 0); });
  }
}

/// The first t at which a point that is left is inside the part, grown by that.
std::optional<double> step_along(Cloud cloud, const Cutter& cutter, const CarriedPart& part,
                                 const CutMove& move, double grown_mm, double flutes_slack_mm) {
  constexpr int kSteps = 150;
  for (int s = 0; s <= kSteps; ++s) {
    const double t = static_cast<double>(s) / kSteps;
    const Pose pose = pose_at(move, t);
    for (const Vec3& p : cloud.points) {
      const Vec2 at = seen_from(pose, p);
      if (at.x > part.radius_mm + grown_mm || at.y < part.from_z_mm - grown_mm ||
          at.y > part.to_z_mm + grown_mm)
        continue;
      if (!in_flutes(cutter, at, *cutter.flute_length_mm(), flutes_slack_mm)) return t;
    }
    std::erase_if(cloud.points, [&](const Vec3& p) {
      return in_flutes(cutter, seen_from(pose, p), *cutter.flute_length_mm(), flutes_slack_mm);
    });
  }
  return std::nullopt;
}

TEST(OctreePart, AgreesWithSteppingAlongTheWay) {
  std::mt19937 random(2020);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  constexpr double kCell_mm = 0.5, kSpacing_mm = 0.5;
  Cloud block;
  for (double x = 0.2; x < 12; x += kSpacing_mm)
    for (double y = 0.2; y < 10; y += kSpacing_mm)
      for (double z = -5.8; z < 0; z += kSpacing_mm) block.points.emplace_back(x, y, z);
  int touching = 0, clear = 0;
  for (int round = 0; round < 60; ++round) {
    const auto tree = make_octree("box:0,0,-6:12,10,0", kCell_mm);
    Cloud cloud = block;
    const Cutter before = make_cutter("ball:5");
    std::vector<CutMove> cuts;
    for (int i = 0; i < 2; ++i) {
      const Vec3 axis = tilted(between(-0.6, 0.6), between(0, 6));
      cuts.push_back(line({between(0, 12), between(0, 10), between(-5, -1)},
                          {between(0, 12), between(0, 10), between(-5, -1)}, 0, axis));
      cloud.cut(before, cuts.back(), 1e9, 200);
    }
    cut(*tree, before, cuts);
    const double width = between(2, 5), flutes = between(2, 5);
    const Cutter cutter =
        make_cutter("flat:" + std::to_string(width) + ":flute=" + std::to_string(flutes));
    const double from = flutes + between(0, 4);
    const CarriedPart part{between(1, 7), from, from + between(2, 12)};
    CutMove move = line({between(-2, 14), between(-2, 12), between(-6, 1)},
                        {between(-2, 14), between(-2, 12), between(-6, 1)}, 0,
                        tilted(between(-0.9, 0.9), between(0, 6)));
    if (round % 2 == 1)
      move.axis_to = glm::normalize(move.axis_from + 0.3 * tilted(between(-2, 2), between(0, 6)));
    const auto met = tree->part_contact(cutter, part, move, kTolerance_mm);
    // What a point of the cloud shows must be found; what is found, be near such a point.
    const auto sure = step_along(cloud, cutter, part, move, -0.5 * kCell_mm, 0.05);
    const auto perhaps = step_along(cloud, cutter, part, move, kSpacing_mm, -0.05);
    ASSERT_TRUE(met || !sure) << round << " at " << sure.value_or(-1);
    ASSERT_TRUE(perhaps || !met) << round << " at " << met->t << " deep " << met->depth_mm;
    (met ? touching : clear) += 1;
    if (!met) continue;
    EXPECT_LE(met->t, sure.value_or(1) + 0.02) << round;
    EXPECT_GE(met->t, *perhaps - 0.02) << round;
    // So much higher the part clears.
    CarriedPart raised = part;
    raised.from_z_mm = part.from_z_mm + met->depth_mm + 0.02;
    if (raised.from_z_mm >= part.to_z_mm) continue;
    EXPECT_FALSE(tree->part_contact(cutter, raised, move, kTolerance_mm)) << round;
  }
  EXPECT_GT(touching, 15);
  EXPECT_GT(clear, 10);
}

TEST(OctreePart, TheGapAgreesWithPoints) {
  std::mt19937 random(7);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  constexpr double kCell_mm = 0.25;
  const auto tree = make_octree("box:0,0,-8:16,14,0", kCell_mm);
  const Cutter before = make_cutter("flat:6");
  const std::vector<CutMove> cuts{line({3, -5, -4}, {3, 20, -4}, 0, tilted(0.3, 0.4))};
  cut(*tree, before, cuts);
  std::vector<Vec3> surface;
  for (const SurfacePoint& p : surface_points(whole(*tree))) surface.push_back(p.at);
  int near = 0;
  for (int round = 0; round < 50; ++round) {
    const Cutter cutter = make_cutter("ball:2:flute=6");
    const double from = between(7, 10);
    const CarriedPart part{between(2, 6), from, from + between(2, 10)};
    const Vec3 begin{between(-4, 20), between(-4, 18), between(-6, 2)};
    const Vec3 end{between(-4, 20), between(-4, 18), between(-6, 2)};
    const Vec2 lean{between(-0.7, 0.7), between(0, 6)};
    CutMove move = line(begin, end, 0, tilted(lean.x, lean.y));
    if (round % 2 == 1) {
      const Vec2 turn{between(-2, 2), between(0, 6)};
      move.axis_to = glm::normalize(move.axis_from + 0.3 * tilted(turn.x, turn.y));
    }
    double least = 1e9;
    constexpr int kSteps = 100;
    for (const Vec3& p : surface) {
      double own = 1e9;
      bool is_cut = false;
      for (int s = 0; s <= kSteps && !is_cut; ++s) {
        const Vec2 at = seen_from(pose_at(move, static_cast<double>(s) / kSteps), p);
        is_cut = in_cutter(cutter, at.x, at.y, -0.02);
        const double across = std::max(0.0, at.x - part.radius_mm);
        const double along = std::max({0.0, part.from_z_mm - at.y, at.y - part.to_z_mm});
        own = std::min(own, std::hypot(across, along));
      }
      if (!is_cut) least = std::min(least, own);
    }
    const auto gap = tree->part_gap(cutter, part, move, 3);  // of the blank exact, so less
    ASSERT_EQ(gap.has_value(), least < 3) << round;
    EXPECT_LE(tree->part_spare_mm(part, move, 1, 3), std::min(least, 3.0) + 1e-6) << round;
    if (!gap) continue;
    EXPECT_NEAR(gap->mm, least, kCell_mm / 2) << round;
    near += gap->mm > 0;
  }
  EXPECT_GT(near, 15);
}

}  // namespace
}  // namespace kerf::test
