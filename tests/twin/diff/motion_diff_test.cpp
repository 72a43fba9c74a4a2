#include "twin/diff/motion_diff.h"

#include <gtest/gtest.h>

#include "tests/twin/diff/diff_support.h"

namespace kerf {
namespace {

constexpr double kTolerance_mm = 0.001;

/// A rectangle, level by level.
StepWriter rectangle(int levels, double x_mm = 70, double feed = 1200) {
  StepWriter writer({0, 0, 5});
  writer.feed_rate(feed);
  for (int level = 1; level <= levels; ++level) {
    writer.rapid({0, 0, 2}).feed({0, 0, -1.0 * level}).feed({x_mm, 0, -1.0 * level});
    writer.feed({x_mm, 40, -1.0 * level}).feed({0, 40, -1.0 * level}).feed({0, 0, -1.0 * level});
  }
  return writer;
}

MotionDiff diff(const std::vector<DiffStep>& a, const std::vector<DiffStep>& b) {
  return diff_motions(a, b, kTolerance_mm);
}

TEST(MotionDiff, AProgramIsItself) {
  const MotionDiff found = diff(rectangle(4).steps(), rectangle(4).steps());
  EXPECT_TRUE(found.is_same());
  EXPECT_EQ(found.apart_mm, 0);
  EXPECT_EQ(found.a_steps, 24u);
}

TEST(MotionDiff, WhatPostsRoundIsTheSame) {
  std::vector<DiffStep> rounded = rectangle(3).steps();
  for (DiffStep& step : rounded) step.to_mm += Vec3(0.0004, -0.0004, 0);
  const MotionDiff found = diff(rectangle(3).steps(), rounded);
  EXPECT_TRUE(found.is_same());
  EXPECT_NEAR(found.apart_mm, 0.0004 * std::sqrt(2.0), 1e-12);
}

/// One corner by a hundredth: the step into it and the one out of it.
TEST(MotionDiff, AHundredthIsToldWithItsLines) {
  std::vector<DiffStep> edited = rectangle(2).steps();
  edited[2].to_mm.x += 0.01;
  edited[3].from_mm.x += 0.01;
  const MotionDiff found = diff(rectangle(2).steps(), edited);
  ASSERT_EQ(found.hunk_count, 1u);
  const MotionHunk& hunk = found.hunks[0];
  EXPECT_EQ(hunk.a_begin, 2u);
  EXPECT_EQ(hunk.a_end, 4u);
  EXPECT_EQ(hunk.b_begin, 2u);
  EXPECT_EQ(hunk.b_end, 4u);
  EXPECT_EQ(hunk.kinds, kDiffPath);
  EXPECT_NEAR(*hunk.apart_mm, 0.01, 1e-12);
  EXPECT_EQ(hunk.a_at.line, 3u);
  EXPECT_EQ(hunk.b_at.line, 3u);
}

TEST(MotionDiff, AnArcIsItsChords) {
  const std::vector<DiffStep> arc =
      rectangle(1).feed({20, 0, -1}).arc({0, 0, -1}, kPi).feed({0, 0, -1}).steps();
  const std::vector<DiffStep> chords =
      rectangle(1).feed({20, 0, -1}).chords({0, 0, -1}, kPi, 500).feed({0, 0, -1}).steps();
  const MotionDiff found = diff(arc, chords);
  EXPECT_TRUE(found.is_same());
  EXPECT_NEAR(found.apart_mm, 20 * (1 - std::cos(kPi / 1000)), 1e-9);
  // Chords that are too long are not.
  const std::vector<DiffStep> coarse =
      rectangle(1).feed({20, 0, -1}).chords({0, 0, -1}, kPi, 50).feed({0, 0, -1}).steps();
  const MotionDiff other = diff(arc, coarse);
  ASSERT_EQ(other.hunk_count, 1u);
  EXPECT_EQ(other.hunks[0].a_end - other.hunks[0].a_begin, 1u);
  EXPECT_EQ(other.hunks[0].b_end - other.hunks[0].b_begin, 50u);
  EXPECT_NEAR(*other.hunks[0].apart_mm, 20 * (1 - std::cos(kPi / 100)), 1e-9);
}

/// The chords of the same arc, but the rest of it at another feed: that is told.
TEST(MotionDiff, ChordsAtAnotherFeedDifferInFeedAlone) {
  const std::vector<DiffStep> arc = StepWriter({20, 0, 0}).arc({0, 0, 0}, kPi).steps();
  const std::vector<DiffStep> chords =
      StepWriter({20, 0, 0}).feed_rate(500).chords({0, 0, 0}, kPi, 500).steps();
  const MotionDiff found = diff(arc, chords);
  ASSERT_EQ(found.hunk_count, 1u);
  EXPECT_EQ(found.hunks[0].kinds, kDiffFeed);
}

TEST(MotionDiff, AFeedIsOnePlace) {
  const MotionDiff found = diff(rectangle(1).steps(), rectangle(1, 70, 1000).steps());
  ASSERT_EQ(found.hunk_count, 1u);
  EXPECT_EQ(found.hunks[0].kinds, kDiffFeed);
  EXPECT_EQ(found.hunks[0].a_begin, 1u);  // the rapid before has none
  EXPECT_EQ(found.hunks[0].a_end, 6u);
  EXPECT_FALSE(found.hunks[0].apart_mm);
}

TEST(MotionDiff, ALevelThatIsMissingIsOnlyInOne) {
  StepWriter less({0, 0, 5});
  less.feed_rate(1200);
  for (const int level : {1, 3, 4}) {
    less.rapid({0, 0, 2}).feed({0, 0, -1.0 * level}).feed({70, 0, -1.0 * level});
    less.feed({70, 40, -1.0 * level}).feed({0, 40, -1.0 * level}).feed({0, 0, -1.0 * level});
  }
  const MotionDiff found = diff(rectangle(4).steps(), less.steps());
  ASSERT_GE(found.hunk_count, 1u);
  std::size_t only_a = 0, only_b = 0;
  for (const MotionHunk& hunk : found.hunks) {
    only_a += hunk.a_end - hunk.a_begin;
    only_b += hunk.b_end - hunk.b_begin;
  }
  EXPECT_EQ(only_a - only_b, 6u);
}

TEST(MotionDiff, ARapidThatIsAFeedIsTold) {
  const std::vector<DiffStep> a = StepWriter().rapid({10, 0, 0}).feed({20, 0, 0}).steps();
  const std::vector<DiffStep> b = StepWriter().feed({10, 0, 0}).feed({20, 0, 0}).steps();
  const MotionDiff found = diff(a, b);
  ASSERT_EQ(found.hunk_count, 1u);
  EXPECT_NE(found.hunks[0].kinds & kDiffRapid, 0);
  EXPECT_EQ(found.hunks[0].kinds & kDiffPath, 0);
}

TEST(MotionDiff, ADwellIsAnEvent) {
  const std::vector<DiffStep> a = StepWriter().feed({10, 0, 0}).feed({20, 0, 0}).steps();
  const std::vector<DiffStep> b = StepWriter().feed({10, 0, 0}).dwell(1).feed({20, 0, 0}).steps();
  const MotionDiff found = diff(a, b);
  ASSERT_EQ(found.hunk_count, 1u);
  EXPECT_EQ(found.hunks[0].kinds, kDiffEvents);
  EXPECT_EQ(found.hunks[0].a_begin, found.hunks[0].a_end);
}

/// A dwell between moves that differ is none, if both have it.
TEST(MotionDiff, ADwellInBothIsNoDifference) {
  const auto steps = [](double x_mm, double seconds) {
    return StepWriter().feed({x_mm, 0, 0}).dwell(seconds).feed({x_mm, 10, 0}).steps();
  };
  const MotionDiff same = diff(steps(10, 1), steps(10.5, 1));
  ASSERT_EQ(same.hunk_count, 2u);  // before it, and behind it
  for (const MotionHunk& hunk : same.hunks) EXPECT_EQ(hunk.kinds, kDiffPath);
  const MotionDiff other = diff(steps(10, 1), steps(10.5, 2));
  ASSERT_EQ(other.hunk_count, 1u);
  EXPECT_EQ(other.hunks[0].kinds, kDiffPath | kDiffEvents);
}

TEST(MotionDiff, ToolSpindleAndCoolantAreTold) {
  for (const auto& [kind, change] : std::vector<std::pair<DiffKind, void (*)(DiffStep&)>>{
           {kDiffTool, [](DiffStep& s) { s.tool = 2; }},
           {kDiffSpindle, [](DiffStep& s) { s.spindle = SpindleState::kClockwise; }},
           {kDiffCoolant, [](DiffStep& s) { s.flood = true; }},
           {kDiffOutputs, [](DiffStep& s) { s.torch.outputs = 8; }}}) {
    std::vector<DiffStep> changed = rectangle(1).steps();
    change(changed[3]);
    const MotionDiff found = diff(rectangle(1).steps(), changed);
    ASSERT_EQ(found.hunk_count, 1u) << name_of(kind);
    EXPECT_EQ(found.hunks[0].kinds, kind);
    EXPECT_EQ(found.hunks[0].a_begin, 3u);
    EXPECT_EQ(found.hunks[0].a_end, 4u);
  }
}

/// Where the first move comes from nobody knows; where it goes counts.
TEST(MotionDiff, AFirstMoveToElsewhereIsAPath) {
  std::vector<DiffStep> a = StepWriter().rapid({10, 0, 5}).steps();
  a[0].start_known = false;
  std::vector<DiffStep> b = a;
  EXPECT_TRUE(diff(a, b).is_same());
  b[0].to_mm.x = 11;
  const MotionDiff found = diff(a, b);
  ASSERT_EQ(found.hunk_count, 1u);
  EXPECT_EQ(found.hunks[0].kinds, kDiffPath);
}

TEST(MotionDiff, AProgramIsNotAnEmptyOne) {
  EXPECT_TRUE(diff({}, {}).is_same());
  const MotionDiff found = diff(rectangle(1).steps(), {});
  ASSERT_EQ(found.hunk_count, 1u);
  EXPECT_NE(found.hunks[0].kinds & kDiffPath, 0);
}

}  // namespace
}  // namespace kerf
