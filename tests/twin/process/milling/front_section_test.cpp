#include "twin/process/milling/front_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

const Box kBlock{{0, 0, -20}, {50, 30, 0}};

bool in_block(const Vec3& p) {
  return p.x > 0 && p.x < 50 && p.y > 0 && p.y < 30 && p.z > -20 && p.z < 0;
}

CutMove line(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

/// Of a ball of 5 mm radius, so deep.
double cap_mm2(double deep) {
  const double angle = std::acos(1 - deep / 5);
  return 25 * (angle - std::sin(2 * angle) / 2);
}

/// What a function says.
struct Material : SolidPoints {
  explicit Material(std::function<bool(const Vec3&)> is_in) : in(std::move(is_in)) {}
  bool solid_at(const Vec3& point_mm, double) const override { return in(point_mm); }
  std::function<bool(const Vec3&)> in;
};

class FrontSectionTest : public testing::Test {
 protected:
  double mm2(const char* shape, const CutMove& move, double part,
             std::function<bool(const Vec3&)> solid = in_block) {
    const Cutter cutter = parse_shape(shape).value();
    EXPECT_TRUE(FrontSection::takes(cutter, move));
    section_.set(kBlock, 0.25, cutter, move);
    return section_.mm2_at(part, Material(std::move(solid)), 0);
  }
  FrontSection section_;
};

TEST_F(FrontSectionTest, ASlotIsTheCuttersShapeBelowTheTop) {
  for (const double deep : {0.02, 0.1, 0.5, 2.0}) {
    const CutMove way = line({-20, 15, -deep}, {70, 15, -deep});
    EXPECT_NEAR(mm2("flat:10", way, 0.5), 10 * deep, 0.003 * 10 * deep);
    EXPECT_NEAR(mm2("ball:10", way, 0.5), cap_mm2(deep), 0.003 * cap_mm2(deep));
    EXPECT_NEAR(mm2("vee:10:90", way, 0.5), deep * deep, 0.003 * deep * deep);
    EXPECT_EQ(mm2("flat:10", way, 0.1), 0);  // at X-11
    EXPECT_EQ(mm2("flat:10", way, 0.9), 0);  // at X61
    EXPECT_LT(section_.looks(), 2000);
  }
}

/// A wall at X0 is met by the middle of a flat front at first: at X-3 by 2 * sqrt(25 - 9) of it.
TEST_F(FrontSectionTest, AFrontComesIntoAWallByItsMiddle) {
  EXPECT_NEAR(mm2("flat:10", line({-3, 15, -2}, {70, 15, -2}), 0), 8 * 2, 0.05);
}

/// 2 mm beside its middle the block ends.
TEST_F(FrontSectionTest, ASideIsAPartOfIt) {
  EXPECT_NEAR(mm2("flat:10", line({-20, -3, -2}, {70, -3, -2}), 0.5), 2 * 2, 0.02);
}

/// A second layer, 0.1 mm deeper than the first; and the same way again.
TEST_F(FrontSectionTest, OnlyWhatIsLeftCounts) {
  const auto slotted = [](const Vec3& p) {
    return in_block(p) && !(std::abs(p.y - 15) < 5 && p.z > -1);
  };
  EXPECT_NEAR(mm2("flat:10", line({-20, 15, -1.1}, {70, 15, -1.1}), 0.5, slotted), 1, 0.003);
  EXPECT_NEAR(mm2("flat:10", line({-20, 15, -1}, {70, 15, -1}), 0.5, slotted), 0, 1e-3);
}

/// Half a millimetre down a millimetre: the front is a slot's, and the end's disc goes down.
TEST_F(FrontSectionTest, ARampTakesItsFrontAndItsEnd) {
  const CutMove ramp = line({0, 15, 0}, {40, 15, -20});
  const double slope = 0.5, per_way = 1 / std::hypot(1.0, slope);
  // At X20 Z-10, seen along the level: 10 wide, 10 deep, and the disc of pi * 25 half as fast.
  const double level = 10 * 10 + kPi * 25 * slope;
  EXPECT_NEAR(mm2("flat:10", ramp, 0.5), level * per_way, 0.01 * level);
  // Up it takes what is before its end alone, and its end nothing.
  const CutMove up = line({40, 15, -20}, {0, 15, 0});
  EXPECT_NEAR(mm2("flat:10", up, 0.5), 10 * 10 * per_way, 0.01 * level);
}

TEST_F(FrontSectionTest, APlungeTakesItsDisc) {
  EXPECT_NEAR(mm2("flat:6", line({20, 15, 6}, {20, 15, -4}), 0.8), kPi * 9, 0.01 * kPi * 9);
  EXPECT_EQ(mm2("flat:6", line({20, 15, 6}, {20, 15, -4}), 0.5), 0);
  EXPECT_EQ(mm2("flat:6", line({20, 15, -4}, {20, 15, 6}), 0.2), 0);
  EXPECT_NEAR(mm2("flat:6", line({0, 15, 6}, {0, 15, -4}), 0.8), kPi * 4.5, 0.01 * kPi * 9);
}

/// On a circle of 8 mm radius the outer side goes faster: the mean over the width is the middle.
TEST_F(FrontSectionTest, AnArcIsASlotThatBends) {
  CutMove arc = line({33, 15, -2}, {17, 15, -2});
  arc.arc = CutArc{{25, 15, -2}, {0, 0, 1}, kPi};
  EXPECT_NEAR(mm2("flat:10", arc, 0.5), 10 * 2, 0.05);
  EXPECT_NEAR(mm2("ball:10", arc, 0.5), cap_mm2(2), 0.01 * cap_mm2(2));
}

}  // namespace
}  // namespace kerf
