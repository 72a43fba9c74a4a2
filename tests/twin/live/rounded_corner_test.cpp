#include "twin/live/rounded_corner.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

constexpr double kTolerance_mm = 0.5;

Motion move(MotionKind kind, const Vec3& from_mm, const Vec3& to_mm) {
  Motion m;
  m.kind = kind;
  m.from_mm = from_mm;
  m.to_mm = to_mm;
  return m;
}

/// To the corner at X10, then 5 mm along Y.
struct Corner {
  Motion before = move(MotionKind::kTraverse, {0, 0, 0}, {10, 0, 0});
  Motion after = move(MotionKind::kTraverse, {10, 0, 0}, {10, 5, 0});
  RoundedCorner at(const Vec3& tip_mm, double off_mm = 2) const {
    return rounded_corner(before, after, tip_mm, off_mm, kTolerance_mm);
  }
};

TEST(RoundedCorner, IsWithinItsTwoMotions) {
  const Corner corner;
  EXPECT_EQ(corner.at({8, 2, 0}), RoundedCorner::kRight);
  EXPECT_EQ(corner.at({0.1, 4.9, 0}), RoundedCorner::kRight);
  EXPECT_EQ(corner.at({8, 2, 0.4}), RoundedCorner::kRight);
  // Above the two, beyond either end, on the other side.
  EXPECT_EQ(corner.at({8, 2, 0.6}), RoundedCorner::kNone);
  EXPECT_EQ(corner.at({10.6, 2, 0}), RoundedCorner::kNone);
  EXPECT_EQ(corner.at({8, 5.6, 0}), RoundedCorner::kNone);
  EXPECT_EQ(corner.at({-0.6, 2, 0}), RoundedCorner::kNone);
  EXPECT_EQ(corner.at({8, -0.6, 0}), RoundedCorner::kNone);
}

TEST(RoundedCorner, OfASharpAngleIsBetweenItsSides) {
  Corner corner;
  corner.after.to_mm = {0, 5, 0};
  EXPECT_EQ(corner.at({5, 1.2, 0}), RoundedCorner::kRight);
  EXPECT_EQ(corner.at({10.6, 0, 0}), RoundedCorner::kNone);
}

TEST(RoundedCorner, IsOfTheProgramsMaking) {
  Corner corner;
  corner.before.kind = corner.after.kind = MotionKind::kFeed;
  EXPECT_EQ(corner.at({8, 2, 0}), RoundedCorner::kByFeeds);
  corner.before.blend_tolerance_mm = 2.5;
  EXPECT_EQ(corner.at({8, 2, 0}, 2.4), RoundedCorner::kRight);
  EXPECT_EQ(corner.at({8, 2, 0}, 2.6), RoundedCorner::kNone);
  corner.before.path_mode = PathMode::kExactPath;
  EXPECT_EQ(corner.at({8, 2, 0}), RoundedCorner::kNone);
}

TEST(RoundedCorner, IsNoneWhereTheMachineStopsOrGoesOnStraight) {
  Corner corner;
  corner.before.kind = MotionKind::kFeed;  // from a feed to a traverse
  EXPECT_EQ(corner.at({8, 2, 0}), RoundedCorner::kNone);
  corner = {};
  corner.after.to_mm = {20, 0, 0};
  EXPECT_EQ(corner.at({9, 0.4, 0}), RoundedCorner::kNone);
  corner.after.to_mm = {0, 0, 0};
  EXPECT_EQ(corner.at({9, 0.4, 0}), RoundedCorner::kNone);
  corner.after.to_mm = corner.after.from_mm;
  EXPECT_EQ(corner.at({9, 0.4, 0}), RoundedCorner::kNone);
  corner = {};
  corner.after.to_abc_deg[0] = 90;
  EXPECT_EQ(corner.at({8, 2, 0}), RoundedCorner::kNone);
  corner = {};
  corner.after.from_mm = {10, 0, 1};
  EXPECT_EQ(corner.at({8, 2, 0}), RoundedCorner::kNone);
}

}  // namespace
}  // namespace kerf
