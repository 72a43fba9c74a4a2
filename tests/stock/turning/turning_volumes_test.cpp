// The workpiece of a lathe: volumes against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/stock/turning/turning_samples.h"

namespace kerf {
namespace {

using namespace turning_test;

/// What volumes are promised to.
void expect_volume(double expected, double got, int line) {
  EXPECT_NEAR(got / expected, 1, 1e-6) << "line " << line;
}
#define EXPECT_VOLUME(expected, got) expect_volume(expected, got, __LINE__)

TurnedPart bar(double length, double diameter) {
  return *TurnedPart::create(bar_profile(-length, 0, diameter));
}

TEST(TurningVolumes, a_bar_and_a_tube) {
  const TurnedPart solid = bar(80, 40);
  EXPECT_VOLUME(cylinder_mm3(40, 80), solid.blank_mm3());
  const TurnedPart tube = *TurnedPart::create(tube_profile(-80, 0, 40, 24));
  EXPECT_VOLUME(cylinder_mm3(40, 80) - cylinder_mm3(24, 80), tube.remaining_mm3());
  EXPECT_EQ(solid.bounds_mm().min, Vec3(-20, -20, -80));
  EXPECT_EQ(solid.bounds_mm().max, Vec3(20, 20, 0));
}

TEST(TurningVolumes, a_blank_must_be_one_piece_beside_the_axis) {
  EXPECT_FALSE(TurnedPart::create({}));
  EXPECT_FALSE(TurnedPart::create({{{0, -1}, {5, -1}, {5, 3}}}));
  EXPECT_FALSE(TurnedPart::create({{{0, 0}, {5, 0}, {5, std::nan("")}}}));
  EXPECT_FALSE(TurnedPart::create({{{0, 0}, {2001, 0}, {5, 3}}}));
  EXPECT_FALSE(
      TurnedPart::create({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{2, 0}, {3, 0}, {3, 1}, {2, 1}}}));
  EXPECT_TRUE(TurnedPart::create({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}));
}

TEST(TurningVolumes, turning_along_the_axis_leaves_a_cylinder) {
  for (const double nose : {0.0, 0.4, 0.8}) {
    TurnedPart part = bar(80, 40);
    const TurningTool tool(right_hand(nose));
    // Past the left end, so that no trace of the nose stays.
    const TurnCut cut = part.cut(tool, line({2, 17}, {-90, 17}, 7));
    EXPECT_VOLUME(cylinder_mm3(40, 80) - cylinder_mm3(34, 80), cut.removed_mm3);
    EXPECT_VOLUME(cylinder_mm3(34, 80), part.remaining_mm3());
    EXPECT_EQ(cut.id, 7u);
    EXPECT_NEAR(cut.depth_mm, 3, 1e-5);
  }
}

TEST(TurningVolumes, facing_takes_a_slice) {
  TurnedPart part = bar(80, 40);
  const TurningTool tool(*nose_insert({0.4, 2, radians(85), radians(5), 12}));
  // The nose goes past the axis by its radius and more: no pip is left.
  const TurnCut cut = part.cut(tool, line({-1.5, 25}, {-1.5, -0.5}));
  EXPECT_VOLUME(cylinder_mm3(40, 1.5), cut.removed_mm3);
  EXPECT_NEAR(cut.depth_mm, 1.5, 1e-5);
  EXPECT_EQ(part.contours().size(), 1u);
  EXPECT_TRUE(part.freed().empty());
}

TEST(TurningVolumes, a_cone_is_exact_whatever_the_nose) {
  // From r = 20 at z = -30 to r = 5 at z = 0, by the nose's own offset from the line.
  const double half = std::atan2(15, 30);
  for (const double nose : {0.0, 0.4, 1.2}) {
    TurnedPart part = bar(80, 40);
    // Steeper than the cone: a front flank of 85 degrees and a nose.
    const TurningTool tool(right_hand(nose));
    // The nose's centre is at (r, r) from the controlled point, and r from the line.
    const Vec2 normal(std::sin(half), std::cos(half));
    const Vec2 offset = nose * normal - Vec2(nose, nose);
    const Vec2 slope(-30, 15);
    const Vec2 start = Vec2(0, 5) - 0.1 * slope + offset,
               end = Vec2(-30, 20) + 0.1 * slope + offset;
    part.cut(tool, line(start, end));
    EXPECT_VOLUME(cylinder_mm3(40, 50) + cone_mm3(20, 5, 30), part.remaining_mm3());
  }
}

TEST(TurningVolumes, a_ball_by_a_round_insert) {
  // A hemisphere of radius 15 at the end of a bar of 30 mm, from the axis outward.
  for (const double nose : {0.5, 1.5, 4.0}) {
    TurnedPart part = bar(60, 30);
    const TurningTool tool(round_insert(nose));
    part.cut(tool, arc({nose, 0}, {-15, 0}, 0.25));
    part.cut(tool, line({-15, 15 + nose}, {-70, 15 + nose}));
    EXPECT_VOLUME(2.0 / 3 * kPi * 15 * 15 * 15 + cylinder_mm3(30, 45), part.remaining_mm3());
  }
}

TEST(TurningVolumes, a_hollow_ball_by_a_round_insert) {
  // A quarter of a circle of radius 9 sunk into the face: a hollow hemisphere, by a smaller nose.
  for (const double nose : {0.8, 3.0}) {
    TurnedPart part = *TurnedPart::create(bar_profile(-60, 0, 30));
    const TurningTool tool(round_insert(nose));
    const double way = 9 - nose;
    // Roughed first by circles of half the way, so that nothing stays inside.
    for (const double r : {0.3 * way, 0.6 * way, way}) part.cut(tool, arc({0, r}, {0, 0}, 0.25));
    EXPECT_VOLUME(cylinder_mm3(30, 60) - 2.0 / 3 * kPi * 9 * 9 * 9, part.remaining_mm3());
  }
}

TEST(TurningVolumes, a_hollow_half_circle_is_a_torus) {
  // The insert's centre runs to the surface and no deeper: half a circle of area pi r^2 / 2.
  for (const double r : {1.5, 3.0}) {
    TurnedPart part = bar(60, 40);
    const TurnCut cut = part.cut(TurningTool(round_insert(r)), line({-30, 30}, {-30, 20}));
    // Pappus: the centroid is 4 r / 3 pi below the surface.
    const double expected = kPi * r * r / 2 * 2 * kPi * (20 - 4 * r / (3 * kPi));
    EXPECT_VOLUME(expected, cut.removed_mm3);
    EXPECT_NEAR(cut.depth_mm, 2 * r, 1e-4);
  }
}

TEST(TurningVolumes, a_groove_is_as_wide_as_the_insert) {
  TurnedPart part = bar(60, 40);
  const TurningTool tool(*groove_insert({3, 0, 20, 2}));
  const TurnCut cut = part.cut(tool, line({-20, 25}, {-20, 12}));
  EXPECT_VOLUME(cylinder_mm3(40, 3) - cylinder_mm3(24, 3), cut.removed_mm3);
  EXPECT_NEAR(cut.depth_mm, 3, 1e-5);
  EXPECT_NEAR(cut.side_mm[static_cast<std::size_t>(InsertSide::kNose)], 3, 1e-5);
  EXPECT_EQ(cut.side_mm[static_cast<std::size_t>(InsertSide::kFront)], 0);
}

TEST(TurningVolumes, a_bore_by_a_bar_that_points_outward) {
  TurnedPart part = *TurnedPart::create(tube_profile(-60, 0, 40, 16));
  const TurningTool tool(mirrored_in_x(right_hand(0.4)));
  part.cut(tool, line({2, 10}, {-70, 10}));
  EXPECT_VOLUME(cylinder_mm3(40, 60) - cylinder_mm3(20, 60), part.remaining_mm3());
}

TEST(TurningVolumes, a_drill_on_the_axis) {
  TurnedPart part = bar(60, 40);
  Cutter drill = *Cutter::from_profile(
      "drill", {{ProfilePiece::Kind::kLine, 0, 0, 5, 5 / std::tan(radians(59))},
                {ProfilePiece::Kind::kLine, 5, 5 / std::tan(radians(59)), 5, 60}});
  const TurningTool tool(*axial_outline(drill, 90));
  const TurnCut cut = part.cut(tool, line({5, 0}, {-25, 0}));
  const double point = 5 / std::tan(radians(59));
  EXPECT_VOLUME(cylinder_mm3(10, 25 - point) + cone_mm3(5, 0, point), cut.removed_mm3);
}

TEST(TurningVolumes, a_tool_behind_the_axis_cuts_the_same) {
  TurnedPart front = bar(80, 40), back = bar(80, 40);
  const InsertOutline outline = right_hand(0.4);
  front.cut(TurningTool(outline), line({2, 17}, {-40, 17}));
  back.cut(TurningTool(mirrored_in_x(outline)), line({2, -17}, {-40, -17}));
  EXPECT_EQ(front.digest(), back.digest());
}

}  // namespace
}  // namespace kerf
