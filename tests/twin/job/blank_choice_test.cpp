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
