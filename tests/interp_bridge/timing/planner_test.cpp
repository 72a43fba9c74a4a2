// The planner against closed forms and against itself.
#include "interp_bridge/timing/planner.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "tests/interp_bridge/timing/planner_test_support.h"

namespace kerf {
namespace {

/// Servo periods that a stop may cost beyond its closed form.
constexpr double kStop_s = 0.0021;

TEST(Planner, LongFeedIsATrapezoidWithHalfTheAccelerationUnderG64) {
  // t = L / v + v / a, a halved before a stop: 100/50 + 50/250.
  EXPECT_NEAR(plan_of(Path().feed(3000).line(100, 0).motions).clock_s, 2.2, kStop_s);
  EXPECT_NEAR(plan_of(Path(PathMode::kExactStop).feed(3000).line(100, 0).motions).clock_s, 2.1,
              kStop_s);
}

TEST(Planner, ShortFeedIsATriangle) {
  // t = 2 sqrt(L / a): 1 mm never reaches 50 mm/s.
  const Plan plan = plan_of(Path(PathMode::kExactStop).feed(3000).line(1, 0).motions);
  EXPECT_NEAR(plan.clock_s, 2 * std::sqrt(1 / 500.0), kStop_s);
  EXPECT_NEAR(plan.timings[0].peak_mm_per_min, 60 * std::sqrt(500.0), 1e-6);
  EXPECT_EQ(plan.timings[0].programmed_mm_per_min, 3000);
  EXPECT_EQ(plan.timings[0].allowed_mm_per_min, 6000);
}

TEST(Planner, SquareStopsAtEveryCorner) {
  const auto square = [](PathMode mode) {
    return Path(mode).feed(3000).line(20, 0).line(20, 20).line(0, 20).line(0, 0).motions;
  };
  EXPECT_NEAR(plan_of(square(PathMode::kExactStop)).clock_s, 4 * (20 / 50.0 + 50 / 500.0),
              4 * kStop_s);
  // G61 keeps a tenth of the acceleration for the corners where it stops.
  EXPECT_NEAR(plan_of(square(PathMode::kExactPath)).clock_s, 4 * (20 / 50.0 + 50 / 450.0),
              4 * kStop_s);
}

TEST(Planner, ToleranceLimitsHowFarCornersAreCut) {
  PlannerOptions options;
  options.with_path = true;
  const auto square = [](double tolerance) {
    return Path(PathMode::kContinuous, tolerance)
        .feed(3000)
        .line(20, 0)
        .line(20, 20)
        .line(0, 20)
        .line(0, 0)
        .motions;
  };
  const MachineLimits mill = MachineLimits::small_mill();
  for (const double tolerance : {0.01, 0.1, 0.5}) {
    const Plan plan = plan_of(square(tolerance), mill, options);
    // The arc that passes the corner at `tolerance`: R = tolerance / (sqrt 2 - 1) saves
    // (2 - pi/2) R at each of three corners.
    const double radius = tolerance / (std::sqrt(2.0) - 1);
    EXPECT_NEAR(path_length(plan), 80 - 3 * (2 - kPi / 2) * radius, 1e-6);
    double nearest = 1e9;
    for (const PathPiece& p : plan.pieces) {
      nearest = std::min(nearest, glm::length(p.from_mm - Vec3(20, 0, 0)));
    }
    EXPECT_NEAR(nearest, tolerance, 1e-6);
  }
  // Without P as far as the speed wants: a real machine was measured at 71.8 mm.
  EXPECT_NEAR(path_length(plan_of(square(0), mill, options)), 71.8, 0.1);
}

TEST(Planner, CirclesKeepToTheirCentripetalAcceleration) {
  // v^2 / r = 0.866 a; the rest is left for speeding up.
  const Plan plan =
      plan_of(Path(PathMode::kExactStop).feed(6000).arc(0, 0, -1, 0, 40 * kPi).motions);
  const double speed = std::sqrt(500 * std::sqrt(3.0) / 2);
  EXPECT_NEAR(plan.timings[0].allowed_mm_per_min, 60 * speed, 1e-6);
  EXPECT_NEAR(plan.timings[0].peak_mm_per_min, 60 * speed, 1e-6);
  EXPECT_NEAR(plan.clock_s, 40 * kPi / speed + speed / 250, kStop_s);
}

TEST(Planner, FeedAboveWhatTheAxesDoIsTold) {
  const Plan plan =
      plan_of(Path().feed(9000).line(100, 0).line(100, 0, -80).line(0, 0, -80).motions);
  EXPECT_EQ(plan.timings[0].allowed_mm_per_min, 6000);
  EXPECT_EQ(plan.timings[1].allowed_mm_per_min, 3600);  // Z is slower
  EXPECT_EQ(plan.timings[0].programmed_mm_per_min, 9000);
  for (const MotionTiming& t : plan.timings) {
    EXPECT_LE(t.peak_mm_per_min, t.allowed_mm_per_min * (1 + 1e-12));
  }
  // The axes alone would allow a diagonal traverse 141 mm/s; the machine's cap is 100.
  EXPECT_NEAR(plan_of(Path().rapid(300, 300).motions).timings[0].peak_mm_per_min, 6000, 1e-9);
}

TEST(Planner, TheLastFeedIsEnteredAsIfHalfOfItWereStillCutAway) {
  // LinuxCNC does not know yet that nothing follows: v = sqrt(a L), a halved as it is the last.
  const double into = std::sqrt(250.0 * 2);
  const double top = std::sqrt((2 * 250.0 * 2 + into * into) / 2);
  const double braking = (50 * 50 - into * into) / (2 * 500.0);
  const double first_s = 50 / 500.0 + (60 - 2.5 - braking) / 50 + (50 - into) / 500;
  const Plan plan = plan_of(Path().feed(3000).line(60, 0).line(62, 0).motions);
  EXPECT_NEAR(plan.timings[0].duration_s, first_s, 1e-9);
  EXPECT_NEAR(plan.timings[1].duration_s, (2 * top - into) / 250, kStop_s);
  EXPECT_GT(plan.clock_s, plan_of(Path().feed(3000).line(62, 0).motions).clock_s - 0.1);
}

TEST(Planner, CornersThatNoArcFitsArePassedWhileBothMovesRun) {
  PlannerOptions options;
  options.with_path = true;
  const auto nearest_mm = [&](double tolerance) {
    // A quarter of a circle, then straight down: not in one plane.
    Path path(PathMode::kContinuous, tolerance);
    path.feed(1800).line(10, 0).arc(20, 10, 10, 10, kPi / 2).line(20, 10, -20);
    const Plan plan = plan_of(path.motions, MachineLimits::small_mill(), options);
    const Vec3 corner(20, 10, 0);
    double least = 1e9;
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
      if (i > 0) {
        EXPECT_LT(glm::length(plan.pieces[i].from_mm - plan.pieces[i - 1].to_mm), 1e-9);
      }
      least = std::min(least, glm::length(plan.pieces[i].from_mm - corner));
    }
    EXPECT_EQ(plan.pieces.back().to_mm, Vec3(20, 10, -20));
    return least;
  };
  // Without a tolerance by far, with one about as far as that says.
  EXPECT_GT(nearest_mm(0), 0.2);
  EXPECT_LT(nearest_mm(0.05), 0.06);
  EXPECT_GT(nearest_mm(0.05), 0.02);
}

TEST(Planner, MergedFeedsShareTheTimeOfOneLine) {
  Path path(PathMode::kContinuous, 0.01, 0.01);
  path.feed(3000);
  for (int i = 1; i <= 100; ++i) path.line(i, i % 2 == 0 ? 0 : 0.005);
  const Plan plan = plan_of(path.motions);
  EXPECT_NEAR(plan.clock_s, plan_of(Path().feed(3000).line(100, 0).motions).clock_s, 1e-6);
  ASSERT_EQ(plan.timings.size(), 100u);
  // By the speeds along it: from a stand at half of the acceleration, evenly, and to a stand, in
  // which the planner rests for a servo period.
  double sum_s = 0;
  for (const MotionTiming& t : plan.timings) sum_s += t.duration_s;
  EXPECT_NEAR(sum_s, plan.clock_s, 1e-9);
  EXPECT_NEAR(plan.timings[0].duration_s, std::sqrt(2 * 1.0 / 250), 1e-4);
  EXPECT_NEAR(plan.timings[50].duration_s, 1.0 / 50, 1e-4);
  EXPECT_NEAR(plan.timings[99].duration_s, std::sqrt(2 * 1.0 / 250) + 0.001, 1e-4);
}

TEST(Planner, ServoPeriodCapsTheSpeedOfDenseCode) {
  Path path;
  path.feed(60000);
  for (int i = 1; i <= 2000; ++i) path.line(i * 0.02, 0);
  const Plan plan = plan_of(path.motions);
  for (const MotionTiming& t : plan.timings) EXPECT_GE(t.duration_s, 0.001 - 1e-9);
}

TEST(Planner, ScalesWithLengthsSpeedsAndAccelerations) {
  // Ten times the lengths, speeds and accelerations: the same time.
  const auto path = [](double s) {
    return Path(PathMode::kContinuous, 0.1 * s)
        .feed(3000 * s)
        .line(30 * s, 0)
        .line(35 * s, 20 * s)
        .arc(15 * s, 20 * s, 25 * s, 20 * s, kPi)
        .line(15 * s, 0, 4 * s)
        .motions;
  };
  MachineLimits large = MachineLimits::small_mill();
  for (AxisLimits& axis : large.axes) {
    axis.max_velocity *= 10;
    axis.max_acceleration *= 10;
  }
  large.max_linear_velocity_mm_per_s *= 10;
  const double time = plan_of(path(1)).clock_s;
  EXPECT_NEAR(plan_of(path(10), large).clock_s, time, 1e-5 * time);
}

TEST(Planner, WaitsAndStops) {
  Path path;
  path.feed(3000).line(10, 0).dwell(1.25).step(MotionKind::kStop).line(20, 0);
  path.step(MotionKind::kProgramEnd);
  Plan plan;
  TrajectoryPlanner planner(MachineLimits::small_mill(), {}, plan);
  for (const Motion& m : path.motions) planner.push(m);
  // The machine stands at the dwell: everything before it, and it, is known at once.
  EXPECT_GE(plan.timings.size(), 3u);
  planner.finish();
  ASSERT_EQ(plan.timings.size(), path.motions.size());
  EXPECT_EQ(planner.stops(), 1u);
  EXPECT_EQ(plan.timings[1].duration_s, 1.25);
  EXPECT_EQ(plan.timings[2].duration_s, 0);
  PlannerOptions slow;
  slow.tool_change_s = 8;
  slow.spindle_start_s = 2;
  Path tools;
  tools.rapid(10, 0).step(MotionKind::kToolChange);
  tools.state().spindle = SpindleState::kClockwise;
  tools.state().spindle_rpm = 6000;
  tools.rapid(0, 0);
  const double quick = plan_of(tools.motions).clock_s;
  EXPECT_NEAR(plan_of(tools.motions, MachineLimits::small_mill(), slow).clock_s, quick + 10, 1e-9);
}

TEST(Planner, ThreadsFollowTheSpindle) {
  Path path;
  path.state().spindle = SpindleState::kClockwise;
  path.state().spindle_rpm = 600;
  path.rapid(0, 0, -10).rapid(0, 0, 0);
  for (Motion& m : path.motions) {
    m.kind = MotionKind::kThread;
    m.feed_mm_per_min = 1.5;
  }
  // Half a turn of waiting, 1.5 servo periods until that is seen, 10 mm at 15 mm/s, half of 15 mm/s
  // at 300 mm/s2; a rigid tap comes out at once, but for two times 4 periods: the spindle turns.
  const Plan plan = plan_of(path.motions);
  EXPECT_NEAR(plan.timings[0].duration_s, 0.05 + 0.0015 + 10 / 15.0 + 15 / 600.0, 1e-9);
  EXPECT_NEAR(plan.timings[1].duration_s, 10 / 15.0 + 0.008, 1e-9);
  EXPECT_EQ(plan.timings[0].programmed_mm_per_min, 900);
  // G33 stops at its end.
  path.motions.pop_back();
  EXPECT_NEAR(plan_of(path.motions).timings[0].duration_s, 0.05 + 0.0015 + 10 / 15.0 + 15 / 300.0,
              1e-9);
}

TEST(Planner, ASpindleTurnsNoFasterThanItDoes) {
  const auto seconds = [](double s_rpm, double max_rpm) {
    Path path(PathMode::kExactStop);
    path.state().feed_per_rev = true;
    path.state().spindle = SpindleState::kClockwise;
    path.state().spindle_rpm = s_rpm;
    path.feed(0.1).line(10, 0);
    PlannerOptions options;
    options.spindle.max_rpm = max_rpm;
    return plan_of(path.motions, MachineLimits::small_mill(), options).clock_s;
  };
  EXPECT_EQ(seconds(6000, 3000), seconds(3000, 0));
  EXPECT_EQ(seconds(2000, 3000), seconds(2000, 0));
  EXPECT_GT(seconds(2000, 0), seconds(3000, 0) * 1.4);
}

/// Under G96, with a spindle that has to be waited for after each traverse.
TEST(Planner, FeedsWaitForTheSpindleUnderG96) {
  const auto plan = [](double accel_rpm_per_s) {
    Path path(PathMode::kExactStop);
    path.state().feed_per_rev = true;
    path.state().spindle = SpindleState::kClockwise;
    path.state().surface = {100000, 3000, 0};
    path.rapid(40, 0).feed(0.1).line(30, 0).rapid(8, 0).line(8, 0, -1);
    PlannerOptions options;
    options.spindle.accel_rpm_per_s = accel_rpm_per_s;
    return plan_of(path.motions, MachineLimits::small_mill(), options);
  };
  const Plan ideal = plan(0), slow = plan(1000);
  // On its way from X30 to X8 (0.42 s) it follows as fast as it can, and then goes on up to a tenth
  // below what is commanded there, as late as it is measured.
  const double k = 100000 / (2 * kPi);
  double rpm = k / 30, now_s = 0;
  constexpr double kStep_s = 1e-5;
  for (double x = 30, speed = 0; now_s < 0.42 || rpm < k / 8 / 1.1; now_s += kStep_s) {
    speed = std::clamp(std::min(500 * now_s, 500 * (0.42 - now_s)), 0.0, 100.0);
    x = std::max(x - speed * kStep_s, 8.0);
    rpm = std::min(k / x, rpm + 1000 * kStep_s);
  }
  const double waits_s =
      slow.timings[3].start_s - (slow.timings[2].start_s + slow.timings[2].duration_s);
  EXPECT_NEAR(waits_s, now_s - 0.42 + SpindleDrive::kMeasured_s, 0.003);
  EXPECT_NEAR(ideal.timings[3].start_s, ideal.timings[2].start_s + ideal.timings[2].duration_s,
              1e-9);
  EXPECT_NEAR(ideal.timings[1].programmed_mm_per_min, 0.1 * 100000 / (2 * kPi * 30), 1e-6);
}

/// Threads right behind each other stay in step: one wait, and no stop between them.
TEST(Planner, ThreadsInARowWaitOnce) {
  const auto seconds = [](int parts) {
    Path path;
    path.state().spindle = SpindleState::kClockwise;
    path.state().spindle_rpm = 600;
    path.state().feed_per_rev = true;
    path.feed(2);
    for (int i = 1; i <= parts; ++i) {
      Motion m = path.state();
      m.kind = MotionKind::kThread;
      m.from_mm = {0, 0, -30.0 * (i - 1) / parts};
      m.to_mm = {0, 0, -30.0 * i / parts};
      path.motions.push_back(m);
    }
    return plan_of(path.motions).clock_s;
  };
  EXPECT_NEAR(seconds(3), seconds(1), 1e-9);
}

TEST(Planner, BrakesToAStandstillBeforeAFeedThatFollowsTheSpindle) {
  Path path;
  path.state().spindle = SpindleState::kClockwise;
  path.state().spindle_rpm = 1200;
  path.feed(1800).line(20, 0);
  path.state().feed_per_rev = true;
  path.feed(1.2).line(40, 0).line(60, 0);
  path.state().feed_per_rev = false;
  path.feed(1800).line(80, 0);
  // G94 to G95: 30 mm/s to 0 and up to 24 mm/s; from there on without a stop.
  const Plan plan = plan_of(path.motions);
  EXPECT_NEAR(plan.timings[0].duration_s, 20 / 30.0 + 30 / 500.0, 1e-9);
  EXPECT_NEAR(plan.timings[1].duration_s, 20 / 24.0 + 24 / 1000.0, 1e-9);
  EXPECT_NEAR(plan.timings[2].duration_s, 20 / 24.0, 1e-9);
}

TEST(Planner, MovesBehindAToolWordWaitUntilTheToolIsPrepared) {
  const auto path = [](double first_mm, ToolPrepare when) {
    Path p;
    p.feed(1800).line(first_mm, 0).line(first_mm, 10).line(20, 10);
    p.motions[2].tool_prepare = when;
    PlannerOptions options;
    options.with_path = true;
    return plan_of(p.motions, MachineLimits::small_mill(), options);
  };
  // The word goes ahead of the second feed, which is held back. 1 mm takes 0.13 s, and the tool is
  // there after half of an I/O period and one more; 2 ms later the task has sent the second.
  EXPECT_NEAR(path(1, ToolPrepare::kAheadOfLast).timings[1].start_s, 0.15 + 0.002, 1e-9);
  // The second feed, 10 mm, is sent before the word: it lasts longer than that.
  EXPECT_LT(path(1, ToolPrepare::kBehindLast).timings[1].start_s, 0.14);
  // The first, of 10 mm, has run 0.15 s towards a stop, at 30 mm/s already, when it is known to go
  // on: the corner is rounded as ever, only its speeding up was at half of the acceleration.
  const Plan sent = path(10, ToolPrepare::kNone);
  const Plan late = path(10, ToolPrepare::kAheadOfLast);
  EXPECT_NEAR(late.clock_s - sent.clock_s, 30 / 500.0 / 2, 1e-9);
  // 4 mm: more than half of it is run then, so that its corner is not rounded, as the next one is.
  const auto arcs = [](const Plan& plan) {
    return std::count_if(plan.pieces.begin(), plan.pieces.end(),
                         [](const PathPiece& piece) { return piece.curved; });
  };
  EXPECT_EQ(arcs(path(4, ToolPrepare::kNone)), 4);
  EXPECT_EQ(arcs(path(4, ToolPrepare::kAheadOfLast)), 2);
}

TEST(Planner, RotaryMovesTakeFeedAsDegrees) {
  // 3000 deg/min = 50 deg/s, half of 360 deg/s2 at both ends.
  EXPECT_NEAR(plan_of(Path().feed(3000).turn(90).motions).clock_s, 1.8 + 50 / 180.0, kStop_s);
  const Plan plan = plan_of(Path().feed(9000).turn(90).motions);
  EXPECT_EQ(plan.timings[0].allowed_mm_per_min, 5400);
}

TEST(Planner, UnknownStartsAndMissingFeedsTakeNoTime) {
  Path path;
  path.rapid(100, 0).feed(0).line(50, 0).feed(600).line(50, 0).line(60, 0);
  path.motions[0].start_known = false;
  const Plan plan = plan_of(path.motions);
  ASSERT_EQ(plan.timings.size(), 4u);
  EXPECT_EQ(plan.timings[0].duration_s, 0);
  EXPECT_EQ(plan.timings[1].duration_s, 0);
  EXPECT_EQ(plan.timings[2].duration_s, 0);
  EXPECT_GT(plan.timings[3].duration_s, 1);
}

/// A path of lines and arcs that turn at random, some tangent, some folding back.
std::vector<Motion> random_path(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::array<PathMode, 3> modes = {PathMode::kContinuous, PathMode::kExactPath,
                                         PathMode::kExactStop};
  Path path(modes[seed % 5 == 0 ? 1 : (seed % 7 == 0 ? 2 : 0)], seed % 3 == 0 ? 0 : 0.02,
            seed % 2 == 0 ? 0 : 0.02);
  path.feed(600 + 6000 * unit(random));
  double x = 0, y = 0, heading = 0;
  for (int i = 0; i < count; ++i) {
    heading += (unit(random) - 0.5) * (unit(random) < 0.7 ? 0.3 : 6);
    const double length = std::pow(10.0, 2 * unit(random) - 1);
    const double kind = unit(random);
    if (kind < 0.15) {
      const double sweep = (unit(random) - 0.5) * 6;
      const double side = sweep > 0 ? 1 : -1;
      const double cx = x - side * length * std::sin(heading);
      const double cy = y + side * length * std::cos(heading);
      const double c = std::cos(sweep), s = std::sin(sweep);
      const double dx = x - cx, dy = y - cy;
      x = cx + c * dx - s * dy;
      y = cy + s * dx + c * dy;
      path.arc(x, y, cx, cy, sweep);
      heading += sweep;
      continue;
    }
    x += length * std::cos(heading);
    y += length * std::sin(heading);
    if (kind < 0.25) {
      path.rapid(x, y);
    } else {
      path.line(x, y);
    }
  }
  return path.motions;
}

TEST(Planner, ResultsComeInOrderAndLieEndToEnd) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const std::vector<Motion> motions = random_path(seed, 300);
    const Plan plan = plan_of(motions);
    ASSERT_EQ(plan.timings.size(), motions.size()) << "seed " << seed;
    double clock = 0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      EXPECT_EQ(plan.timings[i].index, i);
      EXPECT_NEAR(plan.timings[i].start_s, clock, 1e-9) << "seed " << seed << " motion " << i;
      EXPECT_GE(plan.timings[i].duration_s, 0);
      EXPECT_TRUE(std::isfinite(plan.timings[i].duration_s));
      clock = plan.timings[i].start_s + plan.timings[i].duration_s;
    }
    EXPECT_NEAR(clock, plan.clock_s, 1e-9);
  }
}

TEST(Planner, PlannedPathHasNoGapsAndIsNotRunFasterThanAllowed) {
  PlannerOptions options;
  options.with_path = true;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const std::vector<Motion> motions = random_path(seed, 300);
    const Plan plan = plan_of(motions, MachineLimits::small_mill(), options);
    ASSERT_FALSE(plan.pieces.empty());
    double longest = 0;
    for (std::size_t i = 1; i < plan.pieces.size(); ++i) {
      const double gap = glm::length(plan.pieces[i].from_mm - plan.pieces[i - 1].to_mm);
      longest = std::max(longest, gap);
      const Vec3 r0 = plan.pieces[i].from_mm - plan.pieces[i].arc.center_mm;
      const Vec3 r1 = plan.pieces[i].to_mm - plan.pieces[i].arc.center_mm;
      if (plan.pieces[i].curved) {
        EXPECT_NEAR(glm::length(r0), glm::length(r1), 1e-6) << "seed " << seed;
      }
    }
    EXPECT_LT(longest, 1e-6) << "seed " << seed;
    EXPECT_LT(glm::length(plan.pieces.back().to_mm - motions.back().to_mm), 1e-9);
    EXPECT_GE(plan.clock_s, path_length(plan) / 100.0) << "seed " << seed;
  }
}

TEST(Planner, WithTheProgrammedPathUnderG61) {
  PlannerOptions options;
  options.with_path = true;
  std::vector<Motion> motions = random_path(3, 100);
  for (Motion& m : motions) {
    m.path_mode = PathMode::kExactPath;
    m.merge_tolerance_mm = 0;
  }
  const Plan plan = plan_of(motions, MachineLimits::small_mill(), options);
  ASSERT_EQ(plan.pieces.size(), motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    EXPECT_EQ(plan.pieces[i].from_mm, motions[i].from_mm);
    EXPECT_EQ(plan.pieces[i].to_mm, motions[i].to_mm);
    EXPECT_EQ(plan.pieces_before[i], i + 1);
  }
}

TEST(Planner, DelayIsBounded) {
  Plan plan;
  TrajectoryPlanner planner(MachineLimits::small_mill(), {}, plan);
  Path path;
  path.feed(3000);
  for (int i = 1; i <= 5000; ++i) path.line(i, i % 2);
  for (std::size_t i = 0; i < path.motions.size(); ++i) {
    planner.push(path.motions[i]);
    ASSERT_LE(i + 1 - plan.timings.size(), 60u);
  }
}

TEST(Planner, OddMotionsAndMissingLimitsGiveFiniteTimes) {
  MachineLimits bare;  // no axis known at all
  MachineLimits no_z = MachineLimits::small_mill();
  no_z.axes[2] = {};
  MachineLimits parabolic = MachineLimits::small_mill();
  parabolic.arc_blend = false;
  for (const MachineLimits& limits : {bare, no_z, parabolic}) {
    for (const double tolerance : {0.0, 0.05}) {
      Path path(PathMode::kContinuous, tolerance, tolerance);
      path.feed(1000).line(1, 0, 1).line(1, 0, 1).line(0, 0, 0).line(0, 0, 5);
      path.arc(0, 0, 0, 0, kPi);      // no radius, no length
      path.arc(3, 0, 0, 0, kPi);      // begins at its centre
      path.arc(3, 0, 2, 0, 4 * kPi);  // two turns
      path.arc(3 + 1e-9, 0, 3, 1e-5, 1e-4);
      path.line(3, 1e-13).line(3, 1e-13 + 1e-12).turn(5).turn(0).line(0, 0, 0).line(3, 0);
      path.line(-3, 0).line(3, 1e-7);
      const Plan plan = plan_of(path.motions, limits);
      ASSERT_EQ(plan.timings.size(), path.motions.size());
      for (const MotionTiming& t : plan.timings) {
        EXPECT_TRUE(std::isfinite(t.duration_s) && t.duration_s >= 0) << t.index;
        EXPECT_TRUE(std::isfinite(t.start_s) && std::isfinite(t.peak_mm_per_min)) << t.index;
      }
      EXPECT_GT(plan.clock_s, 1.0);
      EXPECT_LT(plan.clock_s, 60.0);
    }
  }
}

Motion slide(const Vec3& by_mm, const Vec3& by_uvw_mm, double a_deg = 0) {
  Motion m;
  m.kind = MotionKind::kFeed;
  m.path_mode = PathMode::kExactStop;
  m.feed_mm_per_min = 3000;
  m.to_mm = by_mm;
  m.to_uvw_mm = by_uvw_mm;
  m.to_abc_deg[0] = a_deg;
  return m;
}

MachineLimits mill_with_a_quill() {
  MachineLimits limits = MachineLimits::small_mill();
  limits.axes[8] = {.present = true, .max_velocity = 40, .max_acceleration = 200};
  return limits;
}

TEST(Planner, AFeedIsOfUvwWhereXyzStandAndOfAbcLast) {
  const MachineLimits limits = mill_with_a_quill();
  const auto seconds = [&](const Motion& m) { return plan_of(std::span(&m, 1), limits).clock_s; };
  // W alone: 3000 mm/min are 50 mm/s, and W does 40. t = L / v + v / a.
  EXPECT_NEAR(seconds(slide({}, {0, 0, 20})), 20 / 40.0 + 40 / 200.0, kStop_s);
  // W with A: still W's way, and A keeps up.
  EXPECT_NEAR(seconds(slide({}, {0, 0, 20}, 10)), 20 / 40.0 + 40 / 200.0, kStop_s);
  // A alone: 50 degrees a second.
  EXPECT_NEAR(seconds(slide({}, {}, 100)), 100 / 50.0 + 50 / 360.0, kStop_s);
  // X with W: the feed is that of X, as far as W can: 100 mm of X with 100 of W go at 40 mm/s.
  EXPECT_NEAR(seconds(slide({100, 0, 0}, {0, 0, 100})), 100 / 40.0 + 40 / 200.0, kStop_s);
  EXPECT_NEAR(seconds(slide({100, 0, 0}, {0, 0, 1})), 100 / 50.0 + 50 / 500.0, kStop_s);
}

TEST(Planner, CornersOfMovesOfWAreNotCut) {
  PlannerOptions options;
  options.with_path = true;
  std::vector<Motion> motions = Path().feed(3000).line(20, 0).line(20, 20).motions;
  EXPECT_LT(path_length(plan_of(motions, mill_with_a_quill(), options)), 39);
  motions[0].to_uvw_mm.z = motions[1].from_uvw_mm.z = motions[1].to_uvw_mm.z = 1;
  EXPECT_NEAR(path_length(plan_of(motions, mill_with_a_quill(), options)), 40, 1e-9);
}

TEST(Planner, SaysWhichLimitsItUsed) {
  Plan plan;
  const TrajectoryPlanner planner(MachineLimits::small_mill(), {}, plan);
  EXPECT_EQ(planner.time_model(),
            "LinuxCNC 2.9 trajectory planner, limits of a small mill (no INI given): X 100 mm/s "
            "500 mm/s2, Y 100 mm/s 500 mm/s2, Z 60 mm/s 300 mm/s2, A 90 deg/s 360 deg/s2, B 90 "
            "deg/s 360 deg/s2, C 90 deg/s 360 deg/s2, at most 100 mm/s along the path, servo "
            "period 1 ms; tool change 3 I/O periods of 0.1 s and 0 s, spindle start 0 s, M0 and "
            "M1 no time");
}

}  // namespace
}  // namespace kerf
