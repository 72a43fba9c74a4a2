// Tools at any angle, in a workpiece that is asked about points.
#include "twin/process/milling/solid_front.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"
#include "tests/twin/process/milling/engagement_oracle.h"

namespace kerf {
namespace {

constexpr double kSolidCell_mm = 0.25;

/// A block 60 x 40 x 10 mm with its top at Z0.
class SolidFrontTest : public testing::Test {
 protected:
  SolidFrontTest() {
    OctreeOptions options;
    options.blank = parse_blank("box:0,0,-10:60,40,0").value();
    options.cell_mm = kSolidCell_mm;
    stock_ = std::move(Octree::create(options).value());
  }
  static CutMove way(Vec3 from, Vec3 to, Vec3 axis = {0, 0, 1}) {
    CutMove move;
    move.from_mm = from, move.to_mm = to;
    move.axis_from = move.axis_to = axis;
    return move;
  }
  void cut(const std::string& shape, const CutMove& move) {
    std::vector<CutReport> reports;
    stock_->cut(parse_shape(shape).value(), {&move, 1}, reports);
    stock_->finish(reports);
  }
  EngagementLook look(const std::string& shape, const CutMove& move, double at = 0.5) {
    return front_.look(*stock_, stock_->bounds_mm(), stock_->cell_mm(), parse_shape(shape).value(),
                       move, {at, false});
  }
  std::unique_ptr<Octree> stock_;
  SolidFront front_;
};

TEST_F(SolidFrontTest, UprightItIsAsInHeights) {
  for (const Vec2 ahead : {Vec2(1, 0), Vec2(0, 1), Vec2(-0.6, 0.8)}) {
    const Vec3 from(Vec2(30, 20) - 5.0 * ahead, -2), to(Vec2(30, 20) + 5.0 * ahead, -2);
    const EngagementLook slot = look("flat:8", way(from, to));
    EXPECT_NEAR(slot.angle_rad, kPi, kOracleDegree);
    EXPECT_NEAR(slot.wide_mm, 8, 0.01);
    EXPECT_NEAR(slot.deep_mm, 2, 0.01);
    EXPECT_NEAR(slot.climb, 0.5, 0.01);
    EXPECT_NEAR(slot.contact_mm, 2, 0.01);
    const EngagementLook ball = look("ball:8", way(from, to));
    EXPECT_NEAR(ball.angle_rad, kPi, 4 * kOracleDegree);
    EXPECT_NEAR(ball.deep_mm, 2, 0.05);
    EXPECT_NEAR(ball.effective_mm, 2 * std::sqrt(12.0), 0.1);
  }
  // 2 of 8 mm along the upper side, the block on the right: acos(1 - 2 / 4) = 60 degrees, climb.
  const EngagementLook side = look("flat:8", way({20, 42, -3}, {40, 42, -3}));
  EXPECT_NEAR(side.entry_rad, 2 * kPi / 3, kOracleDegree);
  EXPECT_NEAR(side.exit_rad, kPi, kOracleDegree);
  EXPECT_EQ(side.climb, 1);
  EXPECT_NEAR(side.deep_mm, 3, 0.01);
  // The same way again is in nothing.
  cut("flat:8", way({-10, 20, -2}, {70, 20, -2}));
  EXPECT_FALSE(look("flat:8", way({-10, 20, -2}, {70, 20, -2})).is_engaged());
}

/// The spindle lies along Y, its tip 3 mm in the block's side, its disc 2 of 8 mm below the top.
TEST_F(SolidFrontTest, LyingDownItIsTheSameTurned) {
  const EngagementLook lying = look("flat:8", way({20, 3, 2}, {40, 3, 2}, {0, -1, 0}));
  EXPECT_NEAR(lying.angle_rad, kPi / 3, kOracleDegree);
  EXPECT_NEAR(lying.entry_rad, 2 * kPi / 3, kOracleDegree);
  EXPECT_NEAR(lying.exit_rad, kPi, kOracleDegree);
  EXPECT_NEAR(lying.wide_mm, 2, 0.05);
  EXPECT_NEAR(lying.deep_mm, 3, 0.02);
  EXPECT_EQ(lying.climb, 1);
  // The other way round it is conventional.
  const EngagementLook back = look("flat:8", way({40, 3, 2}, {20, 3, 2}, {0, -1, 0}));
  EXPECT_NEAR(back.entry_rad, 0, kOracleDegree);
  EXPECT_NEAR(back.exit_rad, kPi / 3, kOracleDegree);
  EXPECT_EQ(back.climb, 0);
}

/// Tilted by 45 degrees, across its way: the depth along the spindle from a tip 3 mm deep is
/// 3 / cos 45 above the tip, more on the side that leans into the block.
TEST_F(SolidFrontTest, TiltedItsDepthIsAlongTheSpindle) {
  const double half = std::sqrt(0.5);
  const EngagementLook tilted = look("flat:4", way({20, 20, -5}, {40, 20, -5}, {0, half, half}));
  EXPECT_NEAR(tilted.angle_rad, kPi, 2 * kOracleDegree);
  // On the side that is lower, 2 mm from the axis: -5 - 2 * half; up to Z0 along the spindle.
  EXPECT_NEAR(tilted.deep_mm, (5 + 2 * half) / half, 0.1);
}

TEST_F(SolidFrontTest, AlongTheSpindleItPlunges) {
  const double half = std::sqrt(0.5);
  const EngagementLook down = look("flat:6", way({30, 20, 3}, {30, 20, -3}), 1);
  EXPECT_TRUE(down.is_plunge);
  EXPECT_TRUE(down.cuts_centre);
  EXPECT_NEAR(down.deep_mm, 3, 0.05);
  EXPECT_NEAR(down.wide_mm, 6, 0.4);
  const Vec3 axis(0, half, half), tip(30, 20, -3);
  EXPECT_TRUE(look("flat:6", way(tip + 6.0 * axis, tip, axis), 1).is_plunge);
  EXPECT_FALSE(look("flat:6", way(tip, tip + 6.0 * axis, axis), 1).is_engaged());
}

/// Straight ways at random, against exact geometry.
TEST_F(SolidFrontTest, AnglesAreThoseOfExactGeometry) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const Cutter cutter = parse_shape("flat:8").value();
  EngagementOracle oracle(stock_->bounds_mm());
  EngagementErrors errors;
  for (int n = 0; n < 24; ++n) {
    const double z = -1 - 0.2 * n;
    const Vec3 from{60 * unit(random), 40 * unit(random), z};
    const Vec3 to{60 * unit(random), 40 * unit(random), z};
    const CutMove move = way(from, to);
    for (const double at : {0.2, 0.5, 0.8})
      errors.add(look("flat:8", move, at), oracle.look(cutter, move, at));
    cut("flat:8", move);
    oracle.add(cutter, move);
  }
  EXPECT_GE(errors.within, 0.97 * errors.looks) << errors.text();
  RecordProperty("errors", errors.text());
}

}  // namespace
}  // namespace kerf
