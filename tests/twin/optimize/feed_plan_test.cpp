// Which words are changed, where the text alone decides; loops and subroutines are for
// tests/lists/check_optimize, as an interpreter has to read them.
#include "twin/optimize/feed_plan.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace kerf {
namespace {

constexpr double kAir = 0;

/// A program, and what its lines do.
class FeedPlanTest : public testing::Test {
 protected:
  /// `most`: what the cut allows; kAir: it touches nothing.
  SurveyedMotion& move(std::uint32_t line, double feed, double most) {
    SurveyedMotion& motion = motions_.emplace_back();
    motion.source.line = line;
    motion.feed_mm_per_min = feed;
    motion.is_measured = true;
    motion.is_engaged = most != kAir;
    motion.removed_mm3 = most != kAir ? 1 : 0;
    if (most != kAir) motion.limit_mm_per_min = most;
    return motion;
  }
  std::string planned(const std::string& text) {
    const NcText nc(text, false);
    plan_ = plan_feeds(nc, feed_blocks(nc, motions_), aims_, {});
    return nc.with(plan_.edits);
  }

  std::vector<SurveyedMotion> motions_;
  FeedAims aims_;
  FeedPlan plan_;
};

TEST_F(FeedPlanTest, AFeedOfItsOwnIsChanged) {
  move(1, 200, 300);
  EXPECT_EQ(planned("G1 X1 F200\n"), "G1 X1 F300\n");
  EXPECT_EQ(plan_.changed, 1u);
}

TEST_F(FeedPlanTest, BlocksBehindItGoOnAtIt) {
  move(1, 200, 300);
  move(2, 200, 320);
  move(3, 200, 500);
  EXPECT_EQ(planned("G1 X1 F200\nX2\nX3\n"), "G1 X1 F300\nX2\nX3 F500\n");
  EXPECT_EQ(plan_.changed, 3u);
}

TEST_F(FeedPlanTest, AWordInEachBlockIsNoStepInEachBlock) {
  move(1, 200, 300);
  move(2, 200, 325);
  move(3, 200, 340);
  EXPECT_EQ(planned("G1 X1 F200\nX2 F200\nX3 F200\n"), "G1 X1 F300\nX2 F300\nX3 F340\n");
}

TEST_F(FeedPlanTest, AWordThatMovesNothingIsChangedForTheBlockBehindIt) {
  move(2, 200, 300);
  EXPECT_EQ(planned("F200 (all)\nG1 X1\n"), "F300 (all)\nG1 X1\n");
}

TEST_F(FeedPlanTest, LittleIsLeftOutButNotWhereItIsTooMuch) {
  move(1, 200, 219);
  move(2, 300, 299);
  EXPECT_EQ(planned("G1 X1 F200\nX2 F300\n"), "G1 X1 F200\nX2 F299\n");
}

TEST_F(FeedPlanTest, WhatStaysSaysItsOwnFeed) {
  move(1, 200, 300);
  move(2, 200, 210);
  EXPECT_EQ(planned("G1 X1 F200\nX2 (thin)\n"), "G1 X1 F300\nX2 F200 (thin)\n");
}

TEST_F(FeedPlanTest, NothingIsMadeFasterThanTheMachine) {
  move(1, 200, 5000).allowed_mm_per_min = 1200;
  move(2, 3000, 5000).allowed_mm_per_min = 1200;
  EXPECT_EQ(planned("G1 X1 F200\nX2 F3000\n"), "G1 X1 F1200\nX2 F3000\n");
}

TEST_F(FeedPlanTest, WhatDrillsIsNotMadeFaster) {
  move(1, 100, 300).goes_down = true;
  move(2, 400, 300).goes_down = true;
  EXPECT_EQ(planned("G1 Z-1 F100\nZ-2 F400\n"), "G1 Z-1 F100\nZ-2 F300\n");
}

TEST_F(FeedPlanTest, AirHasAFeedOfItsOwn) {
  move(1, 200, kAir);
  move(2, 200, 300);
  EXPECT_EQ(planned("G1 X1 F200\nX2\n"), "G1 X1 F200\nX2 F300\n");
  aims_.air_feed_mm_per_min = 2000;
  EXPECT_EQ(planned("G1 X1 F200\nX2\n"), "G1 X1 F2000\nX2 F300\n");
  aims_.most_feed_mm_per_min = 1500;
  EXPECT_EQ(planned("G1 X1 F200\nX2\n"), "G1 X1 F1500\nX2 F300\n");
}

/// The blank may begin above where it should.
TEST_F(FeedPlanTest, DownThroughAirToTheBlankIsNotMadeFaster) {
  move(1, 200, kAir).goes_down = true;
  move(2, 400, kAir);
  aims_.air_feed_mm_per_min = 2000;
  EXPECT_EQ(planned("G1 Z1 F200\nX2 F400\n"), "G1 Z1 F200\nX2 F2000\n");
}

TEST_F(FeedPlanTest, WhatHasRemovedSomethingIsNoAir) {
  move(1, 200, kAir).removed_mm3 = 0.01;
  aims_.air_feed_mm_per_min = 2000;
  EXPECT_EQ(planned("G1 X1 F200\n"), "G1 X1 F200\n");
}

TEST_F(FeedPlanTest, ThatOfAllIsKept) {
  move(1, 2000, std::numeric_limits<double>::infinity());
  aims_.most_feed_mm_per_min = 1500;
  EXPECT_EQ(planned("G1 X1 F2000\n"), "G1 X1 F1500\n");
}

TEST_F(FeedPlanTest, TheSlowestOfSeveralRunsCounts) {
  move(1, 200, 900);
  move(1, 200, 300);
  EXPECT_EQ(planned("G1 X1 F200\n"), "G1 X1 F300\n");
}

TEST_F(FeedPlanTest, InchesAreInches) {
  move(2, 254, 508);
  move(3, 254, 1270);
  EXPECT_EQ(planned("G20\nG1 X1 F10\nX2\n"), "G20\nG1 X1 F20\nX2 F50\n");
}

TEST_F(FeedPlanTest, OthersAreLeftAsTheyAre) {
  move(2, 200, 900);
  move(4, 200, 900);
  move(6, 200, 900);
  move(7, 200, 900);
  move(8, 200, 900).is_measured = false;
  const std::string text =
      "G93\nG1 X1 F20\nG95\nX2 F0.1\nG94 (now)\nX3 F#1\nG84 Z-5 F200\nG1 X9 F200\n";
  EXPECT_EQ(planned(text), text);
  EXPECT_EQ(plan_.left.at(2), FeedLeft::kInverseTime);
  EXPECT_EQ(plan_.left.at(4), FeedLeft::kPerTurn);
  EXPECT_EQ(plan_.left.at(6), FeedLeft::kComputed);
  EXPECT_EQ(plan_.left.at(7), FeedLeft::kSynchronous);
  EXPECT_EQ(plan_.left.at(8), FeedLeft::kUnmeasured);
}

TEST_F(FeedPlanTest, BlocksBehindAFeedThatIsWorkedOutStay) {
  move(1, 200, 900);
  move(2, 200, 900);
  move(3, 300, 900);
  EXPECT_EQ(planned("G1 X1 F#1\nX2\nX3 F300\n"), "G1 X1 F#1\nX2\nX3 F900\n");
  EXPECT_EQ(plan_.left.at(2), FeedLeft::kComputed);
}

TEST_F(FeedPlanTest, WhatIsLeftKeepsTheFeedThatItHad) {
  move(1, 200, 900);
  move(2, 200, 900).kind = MotionKind::kProbe;
  EXPECT_EQ(planned("G1 X1 F200\nG38.2 Z-5\n"), "G1 X1 F900\nG38.2 Z-5 F200\n");
}

TEST_F(FeedPlanTest, WhatIsRightStaysAsItIs) {
  const std::string text = "F300\nG1 X1\nX2\nX3 F900\n";
  move(2, 300, 300);
  move(3, 300, 320);
  move(4, 900, 900);
  EXPECT_EQ(planned(text), text);
  EXPECT_EQ(plan_.changed, 0u);
}

TEST_F(FeedPlanTest, ABlockThatIsTooFastIsFound) {
  move(1, 200, 300);
  move(2, 301, 300);
  const NcText nc("G1 X1 F200\nX2 F301\n", false);
  const ExceededFeed over = exceeded_feed(feed_blocks(nc, motions_), aims_, {});
  EXPECT_EQ(over.line, 2u);
  EXPECT_EQ(over.most_mm_per_min, 300);
  EXPECT_EQ(exceeded_feed(feed_blocks(nc, motions_), aims_, {{2, FeedLeft::kTangled}}).line, 0u);
}

}  // namespace
}  // namespace kerf
