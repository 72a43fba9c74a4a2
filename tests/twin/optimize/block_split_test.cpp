#include "twin/optimize/block_split.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace kerf {
namespace {

SurveyedPart part(double length_mm, double limit, double front_mm = 0, double back_mm = 0) {
  SurveyedPart out;
  out.length_mm = length_mm;
  out.diameter_mm = 10;
  out.is_engaged = limit > 0;
  if (out.is_engaged) out.limit_mm_per_min = limit;
  out.soft_front_mm = front_mm;
  out.soft_back_mm = back_mm;
  return out;
}

/// 120 mm along X in line 2.
SurveyedMotion motion(std::size_t parts) {
  SurveyedMotion out;
  out.source.line = 2;
  out.from_mm = {-10, 20, -4};
  out.to_mm = {110, 20, -4};
  out.feed_mm_per_min = 200;
  out.parts = parts;
  out.is_measured = true;
  out.is_engaged = true;
  return out;
}

std::string divided(const std::string& text, const std::vector<SurveyedPart>& parts,
                    const FeedAims& aims = {}) {
  const std::vector<SurveyedMotion> motions{motion(parts.size())};
  return split_blocks(NcText(text, false), motions, parts, aims).text;
}

const std::string kHead = "G90\n";

TEST(SplitBlocks, EndsPiecesWhereAnotherFeedIsWanted) {
  // In the air, entering, in a slot, beside a wall, leaving it.
  const std::vector<SurveyedPart> parts{part(15, 0), part(45, 100, 5), part(60, 300, 0, 5)};
  EXPECT_EQ(divided(kHead + "G1 X110 F200 (all)\n", parts),
            kHead + "G1 X5 F200\nG1 X10\nG1 X50\nG1 X105\nG1 X110 F200 (all)\n");
  EXPECT_EQ(divided(kHead + "x110\r\n", parts), kHead + "x5\r\nx10\r\nx50\r\nx105\r\nx110\r\n");
}

TEST(SplitBlocks, LeavesWhatIsAlikeInOnePiece) {
  EXPECT_EQ(divided(kHead + "G1 X110\n", {part(60, 100), part(60, 120)}), kHead + "G1 X110\n");
  // And what is too short: a quarter of 10 mm.
  EXPECT_EQ(divided(kHead + "G1 X110\n", {part(60, 100), part(2, 300), part(58, 100)}),
            kHead + "G1 X110\n");
}

TEST(SplitBlocks, LeavesWhatItDoesNotUnderstand) {
  const std::vector<SurveyedPart> parts{part(60, 100), part(60, 300)};
  for (const char* line : {"G1 X#1\n", "G1 X110 M8\n", "G1 X110 S900\n", "/G1 X110\n", "G1 Y110\n"})
    EXPECT_EQ(divided(kHead + line, parts), kHead + line);
  EXPECT_EQ(divided("G91\nG1 X120\n", parts), "G91\nG1 X120\n");
}

TEST(SplitBlocks, CountsInInches) {
  // 60 of 120 mm: the middle, 50 mm.
  EXPECT_EQ(divided("G20 G90\nG1 X4.330709\n", {part(60, 100), part(60, 300)}),
            "G20 G90\nG1 X1.9685\nG1 X4.330709\n");
}

TracedMotion traced(std::uint32_t line, const Vec3& from, const Vec3& to, std::uint64_t print) {
  TracedMotion out;
  out.source.line = line;
  out.kind = MotionKind::kFeed;
  out.from_mm = from;
  out.to_mm = to;
  out.print = print;
  return out;
}

TEST(WayDifference, PiecesOnTheLineAreTheLine) {
  FeedTrace before, after;
  before.motions = {traced(1, {0, 0, 0}, {10, 0, 0}, 1), traced(2, {10, 0, 0}, {10, 9, 0}, 2)};
  after.motions = {traced(1, {0, 0, 0}, {4, 0.0001, 0}, 7),
                   traced(2, {4, 0.0001, 0}, {10, 0, 0}, 8), traced(3, {10, 0, 0}, {10, 9, 0}, 2)};
  SplitText split;
  split.line_before = {1, 1, 2};
  EXPECT_EQ(way_difference(before, after, split), "");
  after.motions[0].to_mm.y = after.motions[1].from_mm.y = 0.001;
  EXPECT_EQ(way_difference(before, after, split), "line 1 goes another way");
  after.motions[0].to_mm.y = after.motions[1].from_mm.y = 0;
  after.motions.pop_back();
  EXPECT_EQ(way_difference(before, after, split), "nothing is there of line 2");
}

}  // namespace
}  // namespace kerf
