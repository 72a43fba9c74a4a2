#include "twin/job/blank_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/twin/process/motions.h"

namespace kerf {
namespace {

Box guess(const MotionList& program, double radius_mm = 3) {
  BlankGuess guess(5);
  for (const Motion& m : program.list()) guess.add(m, radius_mm);
  return guess.blank().bounds_mm();
}

TEST(BlankGuess, ZeroOnTopGivesATopAtZero) {
  const Box box = guess(
      MotionList().traverse({10, 10, 5}).feed({10, 10, -2}).feed({60, 30, -2}).feed({60, 30, 5}));
  EXPECT_EQ(box, (Box{{2, 2, -7}, {68, 38, 0}}));
}

TEST(BlankGuess, ZeroOnTheTableGivesAFloorAtZero) {
  const Box box = guess(
      MotionList().traverse({10, 10, 30}).feed({10, 10, 18}).feed({60, 10, 18}).feed({60, 30, 12}));
  EXPECT_EQ(box, (Box{{2, 2, 0}, {68, 38, 18}}));
}

TEST(BlankGuess, WaysToTheNextCutAtFeedGoThroughTheAir) {
  // Two slots of 10 mm below Z0, 400 mm from each other: most of the way is above.
  MotionList slots;
  slots.traverse({10, 10, 10});
  for (const double x : {10.0, 410.0, 10.0}) {
    slots.feed({x, 10, -2}).feed({x + 10, 10, -2}).feed({x + 10, 10, 5});
    slots.feed({x == 10 ? 410.0 : 10.0, 10, 5});
  }
  EXPECT_EQ(guess(slots), (Box{{2, 2, -7}, {428, 18, 0}}));
  // Zero on the table: levels at 8 and 6, ways at 13.
  MotionList table;
  table.traverse({0, 0, 30});
  for (const double z : {8.0, 6.0})
    table.feed({0, 0, z}).feed({50, 0, z}).feed({50, 0, 13}).feed({0, 0, 13});
  EXPECT_EQ(guess(table).max.z, 10);
  // .. and home at feed, far outside.
  EXPECT_EQ(guess(table.feed({-200, 0, 13})), (Box{{-8, -8, 0}, {58, 8, 10}}));
}

TEST(BlankGuess, WaysOverWhatStandsInAPartAreCuts) {
  // Traverses between the cuts: the boss at 8 is cut over, up, along and down.
  MotionList boss;
  boss.traverse({0, 0, 30});
  for (const double y : {0.0, 3.0, 6.0}) {
    boss.traverse({0, y, 30}).feed({0, y, 2}).feed({20, y, 2}).feed({20, y, 8});
    boss.feed({30, y, 8}).feed({30, y, 2}).feed({50, y, 2}).traverse({50, y, 30});
  }
  EXPECT_EQ(guess(boss).max.z, 14);
  // A relief of pillars: more heights than anyone travels at.
  MotionList relief;
  relief.traverse({0, 0, 30});
  for (int i = 0; i < 6; ++i) {
    const double x = 10 * i, z = 2 + 2.0 * i;
    relief.feed({x, 0, 1}).feed({x, 0, z}).feed({x + 10, 0, z}).feed({x + 10, 0, 1});
  }
  EXPECT_EQ(guess(relief).max.z, 14);
}

TEST(BlankGuess, FullCirclesCountWhole) {
  const Box box =
      guess(MotionList().at({10, 0, -1}).arc({10, 0, -1}, {0, 0, -1}, {0, 0, 1}, 2 * kPi));
  EXPECT_EQ(box, (Box{{-18, -18, -6}, {18, 18, 0}}));
}

TEST(BlankGuess, LargeArcsCountOnlyWhereTheyGo) {
  // A nearly straight arc of 10 m radius.
  const double angle = 0.001;
  const Vec3 end(10000 * std::sin(angle), 10000 * (1 - std::cos(angle)), -1);
  const Box box = guess(MotionList().at({0, 0, -1}).arc(end, {0, 10000, -1}, {0, 0, 1}, angle));
  EXPECT_EQ(box, (Box{{-8, -8, -6}, {18, 9, 0}}));
}

TEST(BlankGuess, IsNeverEmpty) {
  EXPECT_EQ(guess(MotionList()), (Box{{-5, -5, -5}, {5, 5, 0}}));
  BlankGuess bare(0);
  EXPECT_EQ(bare.blank().bounds_mm(), (Box{{-1, -1, -1}, {0, 0, 0}}));
}

TEST(DefaultCell, GivesAtMostFourMillionCells) {
  EXPECT_EQ(default_cell_mm(Box{{0, 0, 0}, {20, 20, 5}}), 0.01);
  EXPECT_EQ(default_cell_mm(Box{{0, 0, 0}, {100, 100, 5}}), 0.05);
  EXPECT_EQ(default_cell_mm(Box{{0, 0, 0}, {200, 200, 5}}), 0.1);
  EXPECT_EQ(default_cell_mm(Box{{0, 0, 0}, {3000, 1500, 18}}), 0.5);
  EXPECT_EQ(default_cell_mm(Box{{0, 0, 0}, {10000, 10000, 18}}), 2.0);
  EXPECT_EQ(default_cell_mm(Box{{0, 0, 0}, {0.005, 10, 5}}), 0.005);
}

}  // namespace
}  // namespace kerf
