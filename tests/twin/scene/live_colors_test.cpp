#include "twin/scene/live_colors.h"

#include <gtest/gtest.h>

#include <array>

namespace kerf {
namespace {

using std::chrono::milliseconds;

class LiveColorsTest : public testing::Test {
 protected:
  static ColorCommand lines(int first, int last) { return {ColorBy::kLineRange, first, last}; }
  /// A cut of a line, by a tool that may be new.
  void cut(int tool, std::uint32_t line, bool is_new_tool = false) {
    const CutLabel label{tool, {0, line}};
    const std::array<NamedTool, 1> name{{{tool, "mill"}}};
    colors_.add({&label, 1}, std::span(name).first(is_new_tool ? 1 : 0));
  }
  /// When enough time has passed.
  std::shared_ptr<const CutColors> take() { return colors_.take(now_ += milliseconds(200)); }
  /// As the window has it.
  static std::uint32_t color(const CutColors& colors, std::size_t label) {
    return label < colors.of_move.size() ? colors.of_move[label] : colors.other;
  }

  LiveColors colors_;
  LiveColors::Clock::time_point now_ = LiveColors::Clock::now();
};

TEST_F(LiveColorsTest, NothingUntilSomebodyAsks) {
  cut(1, 10, true);
  EXPECT_FALSE(take());
  colors_.choose({ColorBy::kTool});
  ASSERT_TRUE(take());
  EXPECT_FALSE(take()) << "once";
  colors_.choose({ColorBy::kHeight});
  EXPECT_FALSE(take());
  cut(2, 20, true);
  EXPECT_FALSE(take());
}

TEST_F(LiveColorsTest, TheQuestionMayComeBeforeTheFirstCut) {
  colors_.choose({ColorBy::kTool});
  ASSERT_TRUE(take());
  cut(1, 10, true);
  const auto first = take();
  ASSERT_TRUE(first);
  ASSERT_EQ(first->legend.size(), 1u);
  EXPECT_EQ(first->legend[0].text, "T1 mill");
  EXPECT_EQ(color(*first, 0), first->legend[0].color);
}

TEST_F(LiveColorsTest, NewLinesOfTheSameToolNeedNoNewTable) {
  colors_.choose({ColorBy::kTool});
  cut(1, 10, true);
  const auto first = take();
  ASSERT_TRUE(first);
  for (std::uint32_t line = 11; line < 50; ++line) cut(1, line);
  EXPECT_FALSE(take());
  EXPECT_EQ(color(*first, 30), color(*first, 0)) << "and have its colour";
  cut(2, 60, true);
  const auto second = take();
  ASSERT_TRUE(second);
  EXPECT_EQ(color(*second, 30), color(*first, 0));
  EXPECT_NE(color(*second, 40), color(*second, 0));
  EXPECT_EQ(color(*second, 99), color(*second, 40)) << "what comes next is this tool's";
  cut(1, 70);
  const auto third = take();
  ASSERT_TRUE(third) << "the first tool is back";
  EXPECT_EQ(color(*third, 41), color(*third, 0));
}

TEST_F(LiveColorsTest, LinesOfTheRange) {
  cut(1, 10, true);
  cut(1, 20);
  colors_.choose(lines(15, 25));
  const auto first = take();
  ASSERT_TRUE(first);
  EXPECT_NE(color(*first, 0), color(*first, 1));
  EXPECT_EQ(color(*first, 1), first->legend.at(0).color);
  EXPECT_EQ(first->legend[0].text, "15 - 25");
  cut(1, 21);
  EXPECT_FALSE(take());
  cut(1, 30);
  const auto second = take();
  ASSERT_TRUE(second);
  EXPECT_EQ(color(*second, 2), color(*second, 1));
  EXPECT_EQ(color(*second, 3), color(*second, 0));
}

TEST_F(LiveColorsTest, AreNotMadeForEveryFrame) {
  colors_.choose({ColorBy::kTool});
  cut(1, 10, true);
  ASSERT_TRUE(take());
  cut(2, 20, true);
  EXPECT_FALSE(colors_.take(now_ + milliseconds(1)));
  EXPECT_TRUE(take()) << "but soon";
  colors_.choose(lines(1, 9));
  EXPECT_TRUE(colors_.take(now_)) << "at once for who asks";
}

TEST_F(LiveColorsTest, ProgramsToolsHaveTheColoursOfKerfView) {
  colors_.choose({ColorBy::kTool});
  cut(9, 1, true);
  cut(2, 10, true);
  colors_.set_program_tools({{1, "rougher"}, {2, "finisher"}});
  const auto colors = take();
  ASSERT_TRUE(colors);
  ASSERT_EQ(colors->legend.size(), 3u);
  EXPECT_EQ(colors->legend[1].text, "T2 finisher");
  EXPECT_EQ(colors->legend[1].color, color_of_number(1));
  EXPECT_EQ(color(*colors, 1), color_of_number(1));
  EXPECT_EQ(colors->legend[2].text, "T9 mill");
  EXPECT_EQ(color(*colors, 0), color_of_number(2));
  EXPECT_EQ(colors_.name_of(2), "mill") << "the tool as it was known when it cut";
}

/// Slow, fast, and through air; what a line removed is divided by the time that all of its cuts
/// took, however often the program ran.
TEST_F(LiveColorsTest, RatesAreOfAllThatALineDid) {
  cut(1, 10, true);
  cut(1, 11);
  cut(1, 12);
  colors_.choose({ColorBy::kRemovalRate});
  const auto none = take();
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->legend.empty()) << "nothing has been told yet";
  colors_.update(
      std::array{LabelUse{0, 10.0, 2.0}, LabelUse{1, 300.0, 3.0}, LabelUse{2, 0.0, 4.0}});
  EXPECT_FALSE(take()) << "not every moment";
  now_ += LiveColors::kRatePeriod;
  const auto colors = take();
  ASSERT_TRUE(colors);
  EXPECT_EQ(colors->mode, ColorBy::kRemovalRate);
  ASSERT_GE(colors->legend.size(), 2u);
  EXPECT_EQ(color(*colors, 0), colors->legend.front().color);
  EXPECT_EQ(colors->legend.front().text, "<= 5 mm\u00b3/s");
  EXPECT_EQ(color(*colors, 1), colors->legend.back().color);
  EXPECT_EQ(colors->legend.back().text, "<= 100 mm\u00b3/s");
  EXPECT_EQ(color(*colors, 2), CutColors{}.other) << "through air";
  now_ += LiveColors::kRatePeriod;
  EXPECT_FALSE(take()) << "nothing was cut since";
  // The line is run again, faster.
  colors_.update(std::array{LabelUse{0, 1010.0, 3.0}});
  const auto later = take();
  ASSERT_TRUE(later);
  EXPECT_EQ(color(*later, 0), later->legend.back().color);
  EXPECT_EQ(color(*later, 1), later->legend.front().color);
}

TEST_F(LiveColorsTest, KnowsItsLabels) {
  cut(1, 10, true);
  ASSERT_TRUE(colors_.label(0));
  EXPECT_EQ(colors_.label(0)->source.line, 10u);
  EXPECT_FALSE(colors_.label(1));
  EXPECT_FALSE(colors_.label(CutLabels::kUnknown));
}

}  // namespace
}  // namespace kerf
