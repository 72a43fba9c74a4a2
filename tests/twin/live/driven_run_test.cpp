// Short ways that are cut as one: which become one, and when they are handed out.
#include "twin/live/driven_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"

namespace kerf {
namespace {

using Way = DrivenRun::Way;
constexpr double kBound_mm = 0.01;
constexpr double kLever_mm = 50;

Motion straight(const Vec3& from, const Vec3& to, double a_from = 0, double a_to = 0) {
  Motion m;
  m.kind = MotionKind::kFeed;
  m.tool = 1;
  m.source.line = 7;
  m.from_mm = from;
  m.to_mm = to;
  m.from_abc_deg[0] = a_from;
  m.to_abc_deg[0] = a_to;
  return m;
}

Motion arc() {
  Motion m = straight({10, 0, 0}, {0, 10, 0}, 5, 25);
  m.kind = MotionKind::kArc;
  m.arc = {{0, 0, 0}, {0, 0, 1}, kPi / 2};
  return m;
}

TEST(DrivenRun, PartsOfOnePieceBecomeThePartThatTheyAre) {
  for (const Motion& piece : {straight({1, 2, 3}, {4, -5, 6}, 10, -20), arc()}) {
    DrivenRun run(kBound_mm, kLever_mm);
    for (int i = 2; i < 9; ++i) {
      const Motion part = part_of(piece, i / 10.0, (i + 1) / 10.0);
      EXPECT_TRUE(run.add(part, i == 2 ? Way::kPart : Way::kNextPart, 0.001, 0.001 * i));
    }
    const auto whole = run.take();
    ASSERT_TRUE(whole);
    const Motion wanted = part_of(piece, 0.2, 0.9);
    EXPECT_LT(glm::length(whole->motion.from_mm - wanted.from_mm), 1e-12);
    EXPECT_LT(glm::length(whole->motion.to_mm - wanted.to_mm), 1e-12);
    EXPECT_NEAR(whole->motion.arc.sweep_rad, wanted.arc.sweep_rad, 1e-12);
    EXPECT_NEAR(whole->motion.from_abc_deg[0], wanted.from_abc_deg[0], 1e-12);
    EXPECT_NEAR(whole->motion.to_abc_deg[0], wanted.to_abc_deg[0], 1e-12);
    EXPECT_NEAR(whole->duration_s, 0.007, 1e-12);
    EXPECT_DOUBLE_EQ(whole->t_s, 0.002);
    EXPECT_TRUE(run.empty());
  }
}

TEST(DrivenRun, WhatDoesNotGoOnLeavesTheRunAsItIs) {
  const Motion first = straight({0, 0, 0}, {1, 0, 0});
  Motion other_tool = straight({1, 0, 0}, {2, 0, 0});
  other_tool.tool = 2;
  Motion other_line = straight({1, 0, 0}, {2, 0, 0});
  other_line.source.line = 8;
  Motion other_spindle = straight({1, 0, 0}, {2, 0, 0});
  other_spindle.spindle = SpindleState::kClockwise;
  Motion other_kinematics = straight({1, 0, 0}, {2, 0, 0});
  other_kinematics.torch.analog[3] = 1;
  for (const Motion& next :
       {other_tool, other_line, other_spindle, other_kinematics, straight({1.001, 0, 0}, {2, 0, 0}),
        straight({1, 0, 0}, {2, 0, 0}, 1, 1)}) {
    for (const bool path : {false, true}) {
      DrivenRun run(kBound_mm, kLever_mm);
      EXPECT_TRUE(run.add(first, path ? Way::kPart : Way::kStraight, 1, 0));
      EXPECT_FALSE(run.add(next, path ? Way::kNextPart : Way::kStraight, 1, 1));
      const auto left = run.take();
      ASSERT_TRUE(left);
      EXPECT_EQ(left->motion.to_mm, first.to_mm);
      EXPECT_EQ(left->duration_s, 1);
    }
  }
}

TEST(DrivenRun, AnotherPieceOrAPositionIsNoNextPart) {
  const Motion first = straight({0, 0, 0}, {1, 0, 0});
  const Motion next = straight({1, 0, 0}, {2, 0, 0});
  DrivenRun path(kBound_mm, kLever_mm);
  EXPECT_TRUE(path.add(first, Way::kPart, 1, 0));
  EXPECT_FALSE(path.add(next, Way::kPart, 1, 1));
  EXPECT_FALSE(path.add(next, Way::kStraight, 1, 1));
  DrivenRun positions(kBound_mm, kLever_mm);
  EXPECT_TRUE(positions.add(first, Way::kStraight, 1, 0));
  EXPECT_FALSE(positions.add(next, Way::kNextPart, 1, 1));
}

TEST(DrivenRun, PositionsInARowBecomeOneWayWithinTheBound) {
  // Round a circle of 10 mm: a chord of the angle a is off by 10 (1 - cos a/2).
  const auto place = [](int i) {
    return Vec3(10 * std::cos(0.005 * i), 10 * std::sin(0.005 * i), 0);
  };
  DrivenRun run(kBound_mm, kLever_mm);
  int together = 0;
  while (run.add(straight(place(together), place(together + 1)), Way::kStraight, 0.001, 0)) {
    ++together;
  }
  const double angle = 0.005 * together;
  EXPECT_LE(10 * (1 - std::cos(angle / 2)), kBound_mm);
  EXPECT_GT(10 * (1 - std::cos((angle + 0.01) / 2)), kBound_mm);
  EXPECT_EQ(run.take()->motion.to_mm, place(together));
}

TEST(DrivenRun, PositionsTurnEvenlyOrAreNotOneWay) {
  DrivenRun run(kBound_mm, kLever_mm);
  EXPECT_TRUE(run.add(straight({0, 0, 0}, {1, 0, 0}, 0, 1), Way::kStraight, 1, 0));
  EXPECT_TRUE(run.add(straight({1, 0, 0}, {2, 0, 0}, 1, 2), Way::kStraight, 1, 1));
  // As straight, and turned twice as fast: at the lever off by 0.2 mm.
  EXPECT_FALSE(run.add(straight({2, 0, 0}, {3, 0, 0}, 2, 4), Way::kStraight, 1, 2));
  // Back the way that it came is no straight way on.
  EXPECT_FALSE(run.add(straight({2, 0, 0}, {1, 0, 0}, 2, 1), Way::kStraight, 1, 2));
  EXPECT_EQ(run.take()->motion.to_mm, Vec3(2, 0, 0));
}

TEST(DrivenRun, IsLongWhenItHasLasted) {
  DrivenRun run(kBound_mm, kLever_mm);
  EXPECT_FALSE(run.is_long(100));
  run.add(straight({0, 0, 0}, {1, 0, 0}), Way::kPart, 0.01, 100);
  EXPECT_FALSE(run.is_long(100 + 0.9 * DrivenRun::kLongest_s));
  EXPECT_TRUE(run.is_long(100.001 + DrivenRun::kLongest_s));
  run.take();
  EXPECT_FALSE(run.is_long(200));
}

}  // namespace
}  // namespace kerf
