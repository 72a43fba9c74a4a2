#include "twin/machine/timeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/twin/process/motions.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr double kTight = 1e-9;

/// Keeps what comes out.
class Recorder final : public StepSink {
 public:
  void step(const Motion& motion, const TimedStep& timed,
            std::span<const PathPiece> path) override {
    lines.push_back(motion.source.line);
    steps.push_back(timed);
    pieces.insert(pieces.end(), path.begin(), path.end());
  }
  std::vector<std::uint32_t> lines;
  std::vector<TimedStep> steps;
  std::vector<PathPiece> pieces;
};

struct Timed {
  explicit Timed(const MotionList& program, const TimelineOptions& options = {}) {
    Timeline timeline(options, recorder);
    for (const Motion& m : program.list()) timeline.push(m);
    timeline.finish();
    totals = timeline.totals();
    clock_s = timeline.clock_s();
  }
  Recorder recorder;
  MotionTotals totals;
  double clock_s = 0;
};

MotionTotals totals_of(const MotionList& program) { return Timed(program).totals; }

TEST(Timeline, EveryMotionComesOutOnceInOrderWithItsTime) {
  MotionList program;
  for (int i = 0; i < 5000; ++i) program.feed({0.1 * (i % 100), 0.1 * i, 0});
  const Timed timed(program);
  ASSERT_EQ(timed.recorder.lines.size(), 5000U);
  double clock = 0;
  for (std::size_t i = 0; i < timed.recorder.steps.size(); ++i) {
    EXPECT_EQ(timed.recorder.lines[i], i + 1);
    ASSERT_NEAR(timed.recorder.steps[i].start_s, clock, 1e-6) << i;
    clock = timed.recorder.steps[i].start_s + timed.recorder.steps[i].duration_s;
  }
  EXPECT_NEAR(timed.clock_s, clock, 1e-9);
  EXPECT_NEAR(timed.totals.duration_s, clock, 1e-6);
}

TEST(Timeline, LongMovesTakeTheirLengthByTheirSpeedAndALittleForTheAcceleration) {
  // A traverse of 1 m: 100 mm/s, 500 mm/s2. A feed of 1 m at 600 mm/min.
  const Timed timed(MotionList().traverse({1000, 0, 0}).feed_rate(600).feed({0, 0, 0}));
  EXPECT_NEAR(timed.totals.traverse_mm, 1000, kTight);
  EXPECT_NEAR(timed.totals.feed_mm, 1000, kTight);
  EXPECT_NEAR(timed.recorder.steps[0].duration_s, 10.3, 0.11);
  EXPECT_NEAR(timed.recorder.steps[1].duration_s, 100, 0.1);
  EXPECT_EQ(timed.recorder.steps[1].programmed_mm_per_min, 600);
  EXPECT_NEAR(timed.recorder.steps[1].allowed_mm_per_min, 6000, 1e-6);
  EXPECT_EQ(timed.totals.moves, 2U);
  EXPECT_EQ(timed.totals.feed_moves, 1U);
  EXPECT_EQ(timed.totals.traverse_moves, 1U);
}

TEST(Timeline, DwellsTakeWhatTheySay) {
  EXPECT_NEAR(totals_of(MotionList().dwell(1.5)).duration_s, 1.5, 0.01);
}

TEST(Timeline, FeedPerRevolutionTakesTheSpindleSpeed) {
  MotionList program;
  program.spindle(true).feed_rate(0.1).feed({100, 0, 0});
  program.last().feed_per_rev = true;
  program.last().spindle_rpm = 1200;  // 120 mm/min
  EXPECT_NEAR(totals_of(program).duration_s, 50, 0.05);
}

TEST(Timeline, FeedWithoutRateTakesNoTimeAndIsCounted) {
  const MotionTotals totals = totals_of(MotionList().feed_rate(0).feed({10, 0, 0}));
  EXPECT_LT(totals.duration_s, 0.01);
  EXPECT_EQ(totals.moves_without_feed, 1U);
}

TEST(Timeline, TotalsBegunWithinAStepHoldThatStep) {
  class Resetter final : public StepSink {
   public:
    void step(const Motion& motion, const TimedStep&, std::span<const PathPiece>) override {
      if (motion.source.line == 2) timeline->begin_totals();
    }
    Timeline* timeline = nullptr;
  } resetter;
  Timeline timeline({}, resetter);
  resetter.timeline = &timeline;
  const MotionList program = MotionList().feed({10, 0, 0}).feed({20, 0, 0}).feed({50, 0, 0});
  for (const Motion& m : program.list()) timeline.push(m);
  timeline.finish();
  EXPECT_EQ(timeline.totals().moves, 2U);
  EXPECT_NEAR(timeline.totals().feed_mm, 40, kTight);
  EXPECT_GT(timeline.clock_s(), timeline.totals().duration_s);
}

TEST(Timeline, ThePlannedPathRoundsCornersAndJoins) {
  MotionList program;
  program.feed_rate(3000).feed({20, 0, 0}).feed({20, 20, 0}).feed({0, 20, 0});
  TimelineOptions options;
  options.planner.with_path = true;
  const std::vector<PathPiece> pieces = Timed(program, options).recorder.pieces;
  ASSERT_GE(pieces.size(), 5U);
  double length = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i > 0) {
      EXPECT_NEAR(glm::length(pieces[i].from_mm - pieces[i - 1].to_mm), 0, 1e-9) << i;
    }
    length += glm::length(pieces[i].to_mm - pieces[i].from_mm);
  }
  EXPECT_LT(length, 59) << "corners are cut";
  EXPECT_GT(length, 40);
  EXPECT_TRUE(Timed(program).recorder.pieces.empty());
}

TEST(Timeline, FirstMoveWithUnknownStartHasNoLength) {
  MotionList program;
  program.traverse({100, 0, 0});
  program.last().start_known = false;
  EXPECT_EQ(totals_of(program).traverse_mm, 0);
  EXPECT_EQ(totals_of(program).moves, 1U);
}

TEST(Timeline, RotaryMovesTakeDegreesPerMinute) {
  MotionList program;
  program.feed_rate(360).feed({0, 0, 0});
  program.last().to_abc_deg = {90, 0, 0};
  EXPECT_NEAR(totals_of(program).duration_s, 15, 0.1);
}

TEST(Timeline, HelixOfThreeTurns) {
  MotionList program;
  program.at({10, 0, 0}).arc({10, 0, -6}, {0, 0, 0}, {0, 0, 1}, 6 * kPi);
  EXPECT_NEAR(totals_of(program).feed_mm, std::hypot(60 * kPi, 6.0), kTight);
}

TEST(MotionGeometry, PointsOfAnArcInXzTurnByTheRightHand) {
  MotionList program;
  // About +Y a quarter turn takes +Z to +X.
  program.at({0, 5, 3}).arc({3, 5, 0}, {0, 5, 0}, {0, 1, 0}, kPi / 2);
  const Vec3 middle = point_at(program.last(), 0.5);
  EXPECT_NEAR(middle.x, 3 / std::sqrt(2.0), kTight);
  EXPECT_NEAR(middle.y, 5, kTight);
  EXPECT_NEAR(middle.z, 3 / std::sqrt(2.0), kTight);
}

/// How far points of the way lie outside the box, and how much the box is larger than needed. mm.
struct BoxFit {
  double outside = 0;
  double loose = 0;
};
BoxFit fit_of(const Motion& m) {
  Box exact;
  for (int i = 0; i <= 3600; ++i) exact.extend(point_at(m, i / 3600.0));
  const Box box = bounds_of(m);
  BoxFit fit;
  for (int i = 0; i < 3; ++i) {
    fit.outside = std::max({fit.outside, box.min[i] - exact.min[i], exact.max[i] - box.max[i]});
    fit.loose = std::max({fit.loose, exact.min[i] - box.min[i], box.max[i] - exact.max[i]});
  }
  return fit;
}

TEST(MotionGeometry, BoundsOfArcsAreExactInAPlane) {
  for (const double start_deg : {0.0, 30.0, 100.0, 200.0, 359.0}) {
    for (const double sweep_deg : {1.0, -1.0, 45.0, -120.0, 180.0, 300.0, -360.0, 800.0}) {
      for (const Vec3 axis : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0.6, 0, 0.8)}) {
        const Vec3 u = glm::normalize(glm::cross(axis, Vec3(0.3, 0.5, -0.2)));
        const Vec3 v = glm::cross(axis, u);
        const Vec3 center(5, 6, 7);
        const auto at = [&](double deg) {
          return center + 10.0 * (std::cos(deg * kPi / 180) * u + std::sin(deg * kPi / 180) * v);
        };
        MotionList program;
        program.at(at(start_deg))
            .arc(at(start_deg + sweep_deg), center, axis, sweep_deg * kPi / 180);
        const BoxFit fit = fit_of(program.last());
        EXPECT_LT(fit.outside, 1e-9) << start_deg << " " << sweep_deg;
        EXPECT_LT(fit.loose, 1e-4) << start_deg << " " << sweep_deg;
      }
    }
  }
}

TEST(MotionGeometry, BoundsOfSpiralHelicesHoldThem) {
  MotionList program;
  program.at({10, 0, 0}).arc({-8, 0, -4}, {0, 0, 0}, {0, 0, 1}, 3 * kPi);
  EXPECT_LT(fit_of(program.last()).outside, 1e-9);
  EXPECT_NEAR(point_at(program.last(), 1).x, -8, kTight) << "a spiral ends at its end";
}

}  // namespace
}  // namespace kerf
