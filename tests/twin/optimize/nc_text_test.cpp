#include "twin/optimize/nc_text.h"

#include <gtest/gtest.h>

#include <string>

namespace kerf {
namespace {

using Feed = NcLine::Feed;

NcLine one_line(const std::string& text) {
  const NcText nc(text, false);
  EXPECT_EQ(nc.lines().size(), 1u) << text;
  NcLine line = nc.lines()[0];
  line.text = {};  // it goes with the text
  return line;
}

std::string with_feed(const std::string& text, const std::string& number) {
  return NcText(text, false).with({{1, {number, {}}}});
}

TEST(NcText, FindsTheFeedWordAndItsNumber) {
  struct Row {
    const char* text;
    Feed feed;
    double number;
  };
  for (const Row& row : {Row{"G1 X10 F300", Feed::kNumber, 300},
                         {"f.5x1", Feed::kNumber, 0.5},
                         {"F 3 0 0 (F7)", Feed::kNumber, 300},
                         {"G1 X1 (F9)", Feed::kNone, 0},
                         {"G1 X1 ; F9", Feed::kNone, 0},
                         {"G1 X1 F#5", Feed::kComputed, 0},
                         {"G1 F[#<_feed>*2]", Feed::kComputed, 0},
                         {"#<f>=300", Feed::kNone, 0},
                         {"X#<feed> Y2", Feed::kNone, 0},
                         {"N30 G1 F+12.5", Feed::kNumber, 12.5}}) {
    const NcLine line = one_line(row.text);
    EXPECT_EQ(line.feed, row.feed) << row.text;
    EXPECT_EQ(line.feed_number, row.number) << row.text;
  }
}

TEST(NcText, PutsANumberInThePlaceOfAnother) {
  EXPECT_EQ(with_feed("G1 X10 F300 (side) Y2\n", "412"), "G1 X10 F412 (side) Y2\n");
  EXPECT_EQ(with_feed("g1x1f 3 0 0y2\r\n", "41.5"), "g1x1f 41.5y2\r\n");
}

TEST(NcText, AddsAWordBehindTheLastOneInTheMannerOfTheLine) {
  EXPECT_EQ(with_feed("G1 X10 Y2 (side)\r\n", "400"), "G1 X10 Y2 F400 (side)\r\n");
  EXPECT_EQ(with_feed("X10(side)", "400"), "X10 F400(side)");
  EXPECT_EQ(with_feed("G1X10Y2;side\n", "400"), "G1X10Y2F400;side\n");
  EXPECT_EQ(with_feed("g1 x10", "400"), "g1 x10 f400");
}

TEST(NcText, LeavesAllElseByteForByte) {
  const std::string text = "%\r\n(a\xff)\nO100 sub\n\n  G1 X1\t\r\nO100 endsub\nM2 ";
  const NcText nc(text, false);
  EXPECT_EQ(nc.with({}), text);
  EXPECT_EQ(nc.with({{5, {"9", {}}}}),
            "%\r\n(a\xff)\nO100 sub\n\n  G1 X1 F9\t\r\nO100 endsub\nM2 ");
}

TEST(NcText, FollowsModesInTheOrderOfTheText) {
  const NcText nc("G20\nX1\nG21 G93\nG94\nG95\nG94 G33 K1\nG1 X2\nG84\nX5\nG80\n", false);
  const auto lines = nc.lines();
  EXPECT_TRUE(lines[1].is_inch);
  EXPECT_FALSE(lines[2].is_inch);
  EXPECT_TRUE(lines[2].inverse_time);
  EXPECT_FALSE(lines[3].inverse_time);
  EXPECT_TRUE(lines[4].per_turn);
  EXPECT_TRUE(lines[5].is_synchronous);
  EXPECT_FALSE(lines[6].is_synchronous);
  EXPECT_TRUE(lines[8].is_synchronous);  // the hole after G84
  EXPECT_FALSE(lines[9].is_synchronous);
}

TEST(NcText, KnowsLinesThatNothingButMoves) {
  const NcText nc("N5 G1 X1 Y2 F30 (a)\nG2 X1 I1\nX#1\nG91\nX1\nG90 G41 D1\nX1\nG40\nX2\n/X3\n",
                  false);
  const auto lines = nc.lines();
  EXPECT_TRUE(lines[0].is_plain_line);
  EXPECT_FALSE(lines[1].is_plain_line);
  EXPECT_FALSE(lines[2].is_plain_line);
  EXPECT_FALSE(lines[4].is_plain_line);
  EXPECT_FALSE(lines[6].is_plain_line);
  EXPECT_TRUE(lines[8].is_plain_line);
  EXPECT_FALSE(lines[9].is_plain_line);
}

TEST(FeedText, NeverSaysMoreThanItMay) {
  EXPECT_EQ(feed_text(346.41), "346");
  EXPECT_EQ(feed_text(300), "300");
  EXPECT_EQ(feed_text(12345.9), "12345");
  EXPECT_EQ(feed_text(99.99), "99.9");
  EXPECT_EQ(feed_text(13.6398), "13.6");
  EXPECT_EQ(feed_text(5), "5");
  EXPECT_EQ(feed_text(0.123456), "0.123");
  EXPECT_EQ(feed_text(0.3 * 1000), "300");  // not 299
}

}  // namespace
}  // namespace kerf
