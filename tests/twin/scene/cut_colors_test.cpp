#include "twin/scene/cut_colors.h"

#include <gtest/gtest.h>

#include "tests/twin/playback/tracks.h"

namespace kerf {
namespace {

std::shared_ptr<const ProgramTrack> two_tool_track() {
  MotionList program;
  program.at({0, 0, 5}).tool(1).feed({10, 0, -1}).feed({20, 0, -1});  // lines 1, 2, 3
  program.tool(2).feed({30, 0, -1}).feed({40, 0, -1});                // lines 4, 5, 6
  return test::track_of(program.list());
}

TEST(CutColors, OneForEachTool) {
  const auto track = two_tool_track();
  ColorCommand wanted;
  wanted.mode = ColorBy::kTool;
  const auto colors = cut_colors(wanted, *track, {{1, "ball 6"}, {2, "bull 4 1"}}, {});
  ASSERT_TRUE(colors);
  ASSERT_EQ(colors->of_move.size(), track->size());
  EXPECT_EQ(colors->of_move[1], colors->of_move[2]);
  EXPECT_EQ(colors->of_move[4], colors->of_move[5]);
  EXPECT_NE(colors->of_move[1], colors->of_move[4]);
  ASSERT_EQ(colors->legend.size(), 2u);
  EXPECT_EQ(colors->legend[1].text, "T2 bull 4 1");
  EXPECT_EQ(colors->legend[1].color, colors->of_move[4]);
}

TEST(CutColors, LinesOfTheMainProgram) {
  const auto track = two_tool_track();
  ColorCommand wanted;
  wanted.mode = ColorBy::kLineRange;
  wanted.first_line = 3;
  wanted.last_line = 5;
  const auto colors = cut_colors(wanted, *track, {}, {});
  ASSERT_TRUE(colors);
  EXPECT_NE(colors->of_move[1], colors->of_move[2]);
  EXPECT_EQ(colors->of_move[2], colors->of_move[4]);
  EXPECT_EQ(colors->of_move[1], colors->of_move[5]);
}

TEST(CutColors, FasterRemovalIsAnotherColor) {
  const auto track = two_tool_track();
  ColorCommand wanted;
  wanted.mode = ColorBy::kRemovalRate;
  const auto colors = cut_colors(wanted, *track, {}, {0, 1, 2, 0, 40, 500});
  ASSERT_TRUE(colors);
  EXPECT_EQ(colors->of_move[0], colors->other) << "a tool change removes nothing";
  EXPECT_NE(colors->of_move[1], colors->of_move[5]);
  EXPECT_FALSE(colors->legend.empty());
}

TEST(CutColors, OtherModesAreNotMadeHere) {
  ColorCommand wanted;
  wanted.mode = ColorBy::kHeight;
  EXPECT_FALSE(cut_colors(wanted, *two_tool_track(), {}, {}));
}

}  // namespace
}  // namespace kerf
