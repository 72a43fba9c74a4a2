#include "twin/live/path_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "tests/twin/live/live_shop.h"
#include "twin/motion/motion_nearest.h"

namespace kerf {
namespace {

/// By trying many points.
double distance_by_trial(const Motion& m, const Vec3& place, double from_t) {
  constexpr int kTrials = 20000;
  double best = 1e30;
  for (int i = 0; i <= kTrials; ++i) {
    const double t = from_t + (1 - from_t) * i / kTrials;
    best = std::min(best, glm::length(point_at(m, t) - place));
  }
  return best;
}

TEST(NearestOn, AgreesWithTrialsOnLinesArcsHelicesAndSpirals) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-20, 20);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 300; ++i) {
    const Vec3 center{anywhere(random), anywhere(random), anywhere(random)};
    const double r0 = 2 + 10 * share(random);
    const double r1 = i % 3 == 0 ? r0 * (1 + 0.2 * share(random)) : r0;
    const double a0 = anywhere(random);
    const double sweep = (i % 2 ? 1 : -1) * (0.1 + 14 * share(random));
    const double rise = i % 4 == 0 ? 0.0 : 5 * share(random);
    MotionList program;
    program.at(center + Vec3{r0 * std::cos(a0), r0 * std::sin(a0), 0});
    const Vec3 to = center + Vec3{r1 * std::cos(a0 + sweep), r1 * std::sin(a0 + sweep), rise};
    if (i % 5 == 0) {
      program.feed(to);
    } else {
      program.arc(to, center, {0, 0, 1}, sweep);
    }
    const Motion& m = program.list()[0];
    const double from_t = i % 2 ? share(random) : 0;
    const Vec3 near = point_at(m, share(random)) + 0.3 * Vec3{share(random), share(random), 0.1};
    for (const Vec3& place : {near, Vec3{anywhere(random), anywhere(random), anywhere(random)}}) {
      const PointOnWay found = nearest_on(m, place, from_t);
      EXPECT_GE(found.t, from_t);
      EXPECT_LE(found.t, 1);
      EXPECT_NEAR(found.distance_mm, glm::length(point_at(m, found.t) - place), 1e-9);
      // Near the path the nearest point is found; far away a turn of a helix may be taken for its
      // neighbour, but never by much.
      const double best = distance_by_trial(m, place, from_t);
      EXPECT_LT(found.distance_mm, best + (best < 1 ? 0.002 : 0.3)) << i;
    }
  }
}

TEST(NearestOn, OfTwoPassagesTheFirst) {
  MotionList program;
  program.at({10, 0, 0}).arc({10, 0, 0}, {0, 0, 0}, {0, 0, 1}, 6 * kPi);
  const Motion& circles = program.list()[0];
  EXPECT_NEAR(nearest_on(circles, {0, 10, 0}, 0).t, 1.0 / 12, 1e-9);
  EXPECT_NEAR(nearest_on(circles, {0, 10, 0}, 0.2).t, 5.0 / 12, 1e-9);
  EXPECT_NEAR(nearest_on(circles, {10, 0, 0}, 0.1).t, 1.0 / 3, 1e-9);
}

TEST(PartOf, TheWholeIsTheMotionAndPartsJoin) {
  MotionList program;
  program.at({10, 0, 0}).arc({0, 10, 3}, {0, 0, 0}, {0, 0, 1}, kPi / 2);
  const Motion& m = program.list()[0];
  const Motion whole = part_of(m, 0, 1);
  EXPECT_EQ(whole.from_mm, m.from_mm);
  EXPECT_EQ(whole.to_mm, m.to_mm);
  EXPECT_EQ(whole.arc.sweep_rad, m.arc.sweep_rad);
  const Motion first = part_of(m, 0, 0.3);
  const Motion second = part_of(m, 0.3, 1);
  EXPECT_EQ(first.to_mm, second.from_mm);
  EXPECT_NEAR(first.arc.sweep_rad + second.arc.sweep_rad, kPi / 2, 1e-12);
  for (const double t : {0.1, 0.5, 0.9}) {
    EXPECT_LT(glm::length(point_at(second, t) - point_at(m, 0.3 + 0.7 * t)), 1e-9);
  }
}

/// Feeds a follower with a machine's places and checks what it drives.
class Chase {
 public:
  explicit Chase(const MotionList& program, FollowOptions options = {})
      : machine_(program.list()), follower_(options) {
    for (const TimedMotion& m : machine_.list()) follower_.append(m.motion, m.step, {});
  }

  PathMatch see(double t_s, bool with_line = false, Vec3 error_mm = Vec3{0}) {
    MatchQuery place;
    place.here.tip_mm = machine_.tip(t_s) + error_mm;
    place.elapsed_s = t_s - t_s_;
    place.tool = machine_.at(t_s).motion.tool;
    if (with_line) place.line = static_cast<int>(machine_.at(t_s).motion.source.line);
    t_s_ = t_s;
    return follower_.follow(place, [&](const PathFollower::DrivenPart& part) {
      if (!driven.empty()) {
        EXPECT_EQ(driven.back().to_mm, part.motion.from_mm);
      }
      driven.push_back(part.motion);
    });
  }
  PathFollower::Drive note() {
    return [this](const PathFollower::DrivenPart& part) { driven.push_back(part.motion); };
  }
  double driven_mm() const {
    double sum = 0;
    for (const Motion& m : driven) sum += path_length_mm(m);
    return sum;
  }
  const RunningMachine& machine() const { return machine_; }
  PathFollower& follower() { return follower_; }

  std::vector<Motion> driven;

 private:
  RunningMachine machine_;
  PathFollower follower_;
  double t_s_ = 0;
};

/// Down, a pocket of zigzags 0.4 mm apart, a helix, pecks, up.
MotionList busy_program() {
  MotionList program;
  program.at({0, 0, 5}).spindle(true).feed_rate(1200);
  program.traverse({1, 1, 5}).feed({1, 1, -1});
  for (int i = 0; i < 20; ++i) {
    const double y = 1 + 0.4 * i;
    program.feed({i % 2 ? 1.0 : 21.0, y, -1}).feed({i % 2 ? 1.0 : 21.0, y + 0.4, -1});
  }
  program.traverse({1, 9, 5}).traverse({30, 10, 5}).feed({30, 10, 0});
  program.arc({30, 10, -4}, {25, 10, 0}, {0, 0, 1}, 8 * kPi);
  program.feed({25, 10, -4}).traverse({25, 10, 5});
  for (int peck = 1; peck <= 4; ++peck) {
    program.traverse({40, 10, peck == 1 ? 1.0 : 1.2 - peck}).feed({40, 10, -1.0 * peck});
    program.traverse({40, 10, 5});
  }
  program.traverse({0, 0, 5});
  return program;
}

TEST(PathFollower, NeverAheadAndNeverFarBehind) {
  for (const double rate_hz : {1000.0, 100.0, 20.0, 5.0}) {
    for (const bool with_line : {false, true}) {
      Chase chase(busy_program());
      const double end_s = chase.machine().duration_s();
      double worst_ahead_s = 0, worst_behind_s = 0;
      for (double t = 0; t < end_s; t += 1 / rate_hz) {
        const PathMatch point = chase.see(t, with_line);
        ASSERT_TRUE(point.on_path) << rate_hz << " Hz, " << t;
        EXPECT_LT(point.distance_mm, 0.021);
        worst_ahead_s = std::max(worst_ahead_s, point.program_s - t);
        worst_behind_s = std::max(worst_behind_s, t - point.program_s);
      }
      EXPECT_TRUE(chase.see(end_s + 1 / rate_hz).on_path);
      // The whole path has been driven, once.
      double whole_mm = 0;
      for (const TimedMotion& m : chase.machine().list()) whole_mm += path_length_mm(m.motion);
      EXPECT_NEAR(chase.driven_mm(), whole_mm, 1e-6) << rate_hz;
      EXPECT_LT(worst_ahead_s, 0.03) << rate_hz;
      // A place that the path comes back to counts as the first visit: a sample or two late.
      EXPECT_LT(worst_behind_s, 0.1 + 2.5 / rate_hz) << rate_hz;
    }
  }
}

/// What comes back to where it began: full circles behind helices, a circle twice, closed squares,
/// a spiral out and in again, a line there and back.
MotionList closed_program(double radius) {
  MotionList program;
  program.at({0, 0, 5}).spindle(true).feed_rate(1500);
  for (int hole = 0; hole < 3; ++hole) {
    const Vec3 start{20.0 * hole, 0, 0};
    const Vec3 center = start + Vec3{radius, 0, 0};
    program.traverse(start + Vec3{0, 0, 5}).feed(start);
    for (int turn = 1; turn <= 3; ++turn) {
      program.arc(start + Vec3{0, 0, -1.5 * turn}, center, {0, 0, 1}, 2 * kPi);
    }
    const Vec3 floor{0, 0, -4.5};
    for (int turn = 0; turn < 2; ++turn) {
      program.arc(start + floor, center + floor, {0, 0, 1}, 2 * kPi);
    }
    program.feed(center + floor).traverse(center + Vec3{0, 0, 5});
  }
  const Vec3 corner{0, 20, -1};
  program.traverse(corner + Vec3{0, 0, 6}).feed(corner);
  for (int round = 0; round < 2; ++round) {
    program.feed(corner + Vec3{4 * radius, 0, 0}).feed(corner + Vec3{4 * radius, 4 * radius, 0});
    program.feed(corner + Vec3{0, 4 * radius, 0}).feed(corner);
  }
  for (int there = 0; there < 3; ++there) program.feed(corner + Vec3{30, 0, 0}).feed(corner);
  const Vec3 eye{40, 40, -1};
  program.feed(eye + Vec3{0.3, 0, 0});
  program.arc(eye + Vec3{3 * radius, 0, 0}, eye, {0, 0, 1}, 6 * kPi);
  program.arc(eye + Vec3{3 * radius, 0, 0}, eye, {0, 0, 1}, 2 * kPi);
  program.arc(eye + Vec3{0.3, 0, 0}, eye, {0, 0, 1}, -6 * kPi);
  program.traverse(eye + Vec3{0.3, 0, 6});
  return program;
}

/// Corners are rounded as under G64: by the mean of the places within so much time.
Vec3 rounded_tip(const RunningMachine& machine, double t_s, double window_s) {
  constexpr int kPlaces = 20;
  Vec3 sum{0};
  for (int i = 0; i <= kPlaces; ++i) {
    const double t = t_s + window_s * (static_cast<double>(i) / kPlaces - 0.5);
    sum += machine.tip(std::clamp(t, 0.0, machine.duration_s()));
  }
  return sum / (kPlaces + 1.0);
}

TEST(PathFollower, ClosedPathsAreNotJumpedOver) {
  constexpr double kRounding_s = 0.03;
  for (const double radius : {1.5, 4.0}) {
    for (const double rate_hz : {1000.0, 200.0, 100.0, 50.0, 20.0, 10.0}) {
      for (const bool with_line : {false, true}) {
        SCOPED_TRACE(testing::Message()
                     << "radius " << radius << ", " << rate_hz << " Hz, lines " << with_line);
        Chase chase(closed_program(radius));
        const double end_s = chase.machine().duration_s();
        double worst_ahead_s = 0, worst_behind_s = 0;
        for (double t = 0; t < end_s; t += 1 / rate_hz) {
          const Vec3 error_mm =
              rounded_tip(chase.machine(), t, kRounding_s) - chase.machine().tip(t);
          const PathMatch point = chase.see(t, with_line, error_mm);
          ASSERT_TRUE(point.on_path) << t;
          worst_ahead_s = std::max(worst_ahead_s, point.program_s - t);
          worst_behind_s = std::max(worst_behind_s, t - point.program_s);
        }
        EXPECT_LT(worst_ahead_s, kRounding_s) << "ahead of the machine";
        EXPECT_LT(worst_behind_s, 0.1 + 2.5 / rate_hz);
        chase.see(end_s);
        chase.see(end_s + 1);
        double whole_mm = 0;
        for (const TimedMotion& m : chase.machine().list()) whole_mm += path_length_mm(m.motion);
        // Parts of a spiral are measured less exactly than the whole.
        EXPECT_NEAR(chase.driven_mm(), whole_mm, 1e-3 * whole_mm);
      }
    }
  }
}

TEST(PathFollower, FollowingErrorsDoNotConfuseIt) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.01);
  Chase chase(busy_program());
  const double end_s = chase.machine().duration_s();
  for (double t = 0; t < end_s; t += 0.01) {
    const PathMatch point = chase.see(t, false, {noise(random), noise(random), noise(random)});
    ASSERT_TRUE(point.on_path);
    EXPECT_LT(point.distance_mm, 0.08);
    EXPECT_LT(std::abs(point.program_s - t), 0.6);
  }
  EXPECT_LT(end_s - chase.see(end_s).program_s, 0.1);
}

TEST(PathFollower, AMachineThatPausesOrRunsAtHalfSpeedIsFollowed) {
  Chase chase(busy_program());
  PathMatch point;
  for (int i = 0; i < 100; ++i) point = chase.see(0.01 * i);
  const double mm = chase.driven_mm();
  PathFollower& follower = chase.follower();
  // It stands for ten minutes.
  MatchQuery still;
  still.here.tip_mm = chase.machine().tip(0.99);
  still.elapsed_s = 0.1;
  for (int i = 0; i < 6000; ++i) {
    point = follower.follow(still, chase.note());
  }
  EXPECT_TRUE(point.on_path);
  EXPECT_NEAR(chase.driven_mm(), mm, 1e-6);
  // And goes on at half the speed.
  const double end_s = chase.machine().duration_s();
  for (double t = 1; t < end_s; t += 0.005) {
    still.here.tip_mm = chase.machine().tip(t);
    still.elapsed_s = 0.01;
    point = follower.follow(still, chase.note());
    ASSERT_TRUE(point.on_path) << t;
  }
  EXPECT_LT(end_s - point.program_s, 0.1);
}

TEST(PathFollower, ATipBesideThePathIsNotOnIt) {
  Chase chase(busy_program());
  for (int i = 0; i < 100; ++i) chase.see(0.01 * i);
  const double mm = chase.driven_mm();
  const PathMatch point = chase.see(1.0, false, {0, 0, 0.7});
  EXPECT_FALSE(point.on_path);
  EXPECT_NEAR(point.distance_mm, 0.7, 0.05);
  EXPECT_EQ(chase.driven_mm(), mm);
  EXPECT_TRUE(chase.see(1.1).on_path);
}

TEST(PathFollower, StandsBeforeAToolChangeUntilTheMachineHasChanged) {
  MotionList program;
  program.at({0, 0, 5}).tool(1).spindle(true).feed_rate(600);
  program.traverse({5, 0, 5}).feed({5, 0, 0}).traverse({5, 0, 5}).tool(2);
  program.feed({5, 0, 0}).feed({9, 0, 0});
  Chase chase(program);
  const auto see = [&](Vec3 tip, int tool) {
    MatchQuery place;
    place.here.tip_mm = tip;
    place.elapsed_s = 0.5;
    place.tool = tool;
    return chase.follower().follow(place, chase.note());
  };
  see({0, 0, 5}, 1);
  see({5, 0, 5}, 1);
  see({5, 0, 0}, 1);
  EXPECT_EQ(see({5, 0, 5}, 1).tool, 1);
  // Down again, with the old tool: that is not in the program, though the place is.
  EXPECT_EQ(see({5, 0, 2}, 1).source.line, 4U);
  EXPECT_FALSE(see({9, 0, 0}, 1).on_path);
  EXPECT_EQ(see({5, 0, 2}, 2).tool, 2);
}

TEST(PathFollower, AnIdleMachineIsNotYetOnThePath) {
  Chase chase(busy_program());
  MatchQuery place;
  place.here.tip_mm = {0, 0, 5};
  place.line = 0;
  EXPECT_FALSE(chase.follower().follow(place, [](const PathFollower::DrivenPart&) {}).on_path);
  place.line = 1;
  EXPECT_TRUE(chase.follower().follow(place, [](const PathFollower::DrivenPart&) {}).on_path);
}

}  // namespace
}  // namespace kerf
