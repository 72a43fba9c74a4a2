// What is special about the look of a workpiece that turns.
#include "twin/scene/turned_look.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <string>

#include "stock/cutter/insert_shape.h"
#include "tests/twin/playback/tracks.h"
#include "twin/scene/drawn_machine.h"
#include "twin/scene/part_patches.h"
#include "twin/scene/tool_shape.h"

namespace kerf {
namespace {

TurningStock stock_of(const TurnedProfile& profile) {
  return TurningStock(*TurnedPart::create(profile));
}

/// Radii and heights at which there are circles.
std::set<std::pair<long, long>> circles(const std::vector<LineSegment>& lines) {
  std::set<std::pair<long, long>> found;
  for (const LineSegment& line : lines) {
    if (line.from_mm.z != line.to_mm.z) continue;
    found.insert({std::lround(glm::length(glm::vec2(line.from_mm)) * 1000),
                  std::lround(line.from_mm.z * 1000)});
  }
  return found;
}

TEST(TurnedLook, ABarIsOutlinedByItsCirclesAndFourLines) {
  const auto lines = turned_outline(stock_of(bar_profile(-60, 0, 40)));
  EXPECT_EQ(circles(lines), (std::set<std::pair<long, long>>{{20000, -60000}, {20000, 0}}));
  int along = 0;
  for (const LineSegment& line : lines) along += line.from_mm.z != line.to_mm.z ? 1 : 0;
  EXPECT_EQ(along, 4);
}

TEST(TurnedLook, ATubeShowsItsBore) {
  const auto lines = turned_outline(stock_of(tube_profile(-60, 0, 40, 16)));
  EXPECT_EQ(circles(lines), (std::set<std::pair<long, long>>{
                                {20000, -60000}, {20000, 0}, {8000, -60000}, {8000, 0}}));
}

/// A program of one file: motions on these lines.
DiameterMode mode_of(const std::string& text, const std::vector<std::uint32_t>& lines) {
  MotionList program;
  program.at({10, 0, 5}).spindle(true);
  for (std::size_t i = 0; i < lines.size(); ++i) program.feed({10, 0, -static_cast<double>(i)});
  std::vector<Motion> motions = program.list();
  std::size_t next = 0;
  for (Motion& m : motions) {
    if (m.kind == MotionKind::kFeed) m.source = {0, lines[next++]};
  }
  ProgramText files;
  files.files.emplace_back("part.ngc", text);
  return DiameterMode(*test::track_of(motions), files);
}

TEST(DiameterMode, HoldsFromG7ToG8) {
  const DiameterMode mode =
      mode_of("g21 g18\nG1 X1\nG7 (dia)\nG1 X2\nG1X3\nN6 G08 G1 X4\nG1 X5\n", {2, 4, 5, 6, 7});
  EXPECT_FALSE(mode.holds_at(0));
  EXPECT_TRUE(mode.holds_at(1));
  EXPECT_TRUE(mode.holds_at(2));
  EXPECT_FALSE(mode.holds_at(3));
  EXPECT_FALSE(mode.holds_at(4));
}

TEST(DiameterMode, ALoopKeepsWhatHolds) {
  const DiameterMode mode = mode_of("G7\nG1 X1\nG1 X2\n", {2, 3, 2, 3});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(mode.holds_at(i));
}

TEST(DiameterMode, CommentsAndLongerNumbersAreNone) {
  const DiameterMode mode = mode_of("(G7)\nG71.1 ; G7\nG70\n#<G7>=1\nG1 X1\n", {5});
  EXPECT_FALSE(mode.holds_at(0));
}

TEST(TurnedLook, AnInsertIsAPlateBehindThePlaneOfTheAxis) {
  NoseInsert insert;
  insert.radius_mm = 0.8;
  insert.orientation = 2;
  insert.front_rad = 85 * kPi / 180;
  insert.back_rad = 5 * kPi / 180;
  const Cutter cutter = Cutter::from_insert("nose", *nose_insert(insert));
  const auto shape = tool_shape_of(cutter);
  EXPECT_TRUE(shape->cutter.empty() && shape->shank.empty() && shape->holder.empty());
  ASSERT_FALSE(shape->plates.empty());
  const ToolPlate& plate = shape->plates.front();
  EXPECT_EQ(plate.high_y_mm, 0);
  EXPECT_LT(plate.low_y_mm, -1);
  double area2 = 0, least_z = 1, least_x = 1;
  int cutting = 0;
  for (std::size_t i = 0; i < plate.corners.size(); ++i) {
    const glm::dvec2 a(plate.corners[i].zx_mm),
        b(plate.corners[(i + 1) % plate.corners.size()].zx_mm);
    area2 += a.x * b.y - a.y * b.x;
    least_z = std::min(least_z, a.x);
    least_x = std::min(least_x, a.y);
    cutting += plate.corners[i].cuts ? 1 : 0;
  }
  EXPECT_GT(area2, 0);  // counter-clockwise
  EXPECT_GT(cutting, 2);
  EXPECT_LT(cutting, static_cast<int>(plate.corners.size()));
  // The controlled point is where the nose touches lines along the axes.
  EXPECT_NEAR(least_z, 0, 0.01);
  EXPECT_NEAR(least_x, 0, 0.01);
}

TEST(TurnedLook, ATurretHoldsInsertsAcrossAndDrillsAlong) {
  const Cutter drill = std::move(parse_tool_argument("1=drill:6:118").value()).cutter;
  const Vec3 along = held_from_tip(*tool_shape_of(drill));
  EXPECT_EQ(along.x, 0);
  EXPECT_GT(along.z, 10);
  NoseInsert insert;
  insert.radius_mm = 0.4;
  insert.orientation = 2;
  insert.front_rad = 85 * kPi / 180;
  insert.back_rad = 5 * kPi / 180;
  const Vec3 across =
      held_from_tip(*tool_shape_of(Cutter::from_insert("nose", *nose_insert(insert))));
  EXPECT_GT(across.x, 5);
  EXPECT_EQ(across.z, 0);
}

/// A contour is off by less than is seen, at every size of pixels.
TEST(TurnedLook, PatchesAreAsFineAsPixels) {
  const TurningStock stock = stock_of(bar_profile(-60, 0, 40));
  for (const double pixel_mm : {0.001, 0.01, 0.05, 0.1, 0.5, 2.0}) {
    const int level = patch_level(stock, pixel_mm);
    EXPECT_LE(0.002 * std::pow(4.0, level), std::max(0.002, 0.25 * pixel_mm)) << pixel_mm;
    if (level < StockModel::kPatchLevels - 1) {
      EXPECT_GT(0.002 * std::pow(4.0, level + 1), 0.25 * pixel_mm) << pixel_mm;
    }
  }
}

}  // namespace
}  // namespace kerf
