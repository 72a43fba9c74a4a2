// Ways of driven tools against what a turned frame makes of them, and which machines they know.
#include "twin/machine/live_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

Vec3 turned_by(const Vec3& p, double deg) {
  const double c = std::cos(deg * kPi / 180), s = std::sin(deg * kPi / 180);
  return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

Motion feed(const Vec3& from, const Vec3& to) {
  Motion motion;
  motion.kind = MotionKind::kFeed;
  motion.from_mm = from;
  motion.to_mm = to;
  return motion;
}

double off_chord(const CutMove& move, const Vec3& p) {
  const Vec3 d = move.to_mm - move.from_mm;
  const double length2 = glm::dot(d, d);
  const double t =
      length2 > 0 ? std::clamp(glm::dot(p - move.from_mm, d) / length2, 0.0, 1.0) : 0.0;
  return glm::length(move.from_mm + t * d - p);
}

TEST(LivePaths, TheToolGoesRightHandedRoundTheWorkpiece) {
  const double cell_mm = 0.2;
  WorkpieceFrame frame;  // wherever the work offset is: the axis is that of the program
  frame.g5x_mm = {120, 7, -300};
  const auto paths = LivePaths::create(nullptr, frame, cell_mm);
  ASSERT_TRUE(paths);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int n = 0; n < 60; ++n) {
    Motion motion = feed({25 * draw(random), 10 * draw(random), 30 * draw(random)},
                         {25 * draw(random), 10 * draw(random), 30 * draw(random)});
    const std::size_t axis = n % 3 == 0 ? 0 : 2;  // A or C
    motion.from_abc_deg[axis] = 180 * draw(random);
    motion.to_abc_deg[axis] = n % 5 == 0 ? motion.from_abc_deg[axis] : 400 * draw(random);
    motion.tool_offset_mm = {20 * draw(random), 0, 50 * draw(random)};
    const LiveAxis live = n % 2 == 0 ? LiveAxis::kX : LiveAxis::kZ;
    const Vec3 along = live == LiveAxis::kX ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
    std::vector<CutMove> moves;
    std::vector<double> ends;
    ASSERT_TRUE(paths->path(live).moves_of(motion, 20, 7, moves, &ends));
    ASSERT_EQ(moves.size(), std::max<std::size_t>(1, ends.size()));
    double before = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const double end = ends.empty() ? 1 : ends[i];
      for (const double t : {before, 0.5 * (before + end), end}) {
        const double deg =
            motion.from_abc_deg[axis] + t * (motion.to_abc_deg[axis] - motion.from_abc_deg[axis]);
        const Vec3 tip = turned_by(motion.from_mm + t * (motion.to_mm - motion.from_mm), deg);
        ASSERT_LT(off_chord(moves[i], tip), 0.0101) << n << ' ' << i;
        if (t == end) {
          ASSERT_LT(glm::length(moves[i].to_mm - tip), 1e-9) << n;
          ASSERT_LT(glm::length(moves[i].axis_to - turned_by(along, deg)), 1e-9) << n;
        }
      }
      EXPECT_EQ(moves[i].id, 7U);
      before = end;
    }
  }
}

TEST(LivePaths, ArcsStayArcsWhileNothingTurns) {
  const auto paths = LivePaths::create(nullptr, {}, 0.2);
  Motion motion = feed({20, 0, -10}, {20, 0, -20});
  motion.kind = MotionKind::kArc;
  motion.arc = {{20, 0, -15}, {1, 0, 0}, kPi};  // G19
  motion.from_abc_deg[2] = motion.to_abc_deg[2] = 90;
  std::vector<CutMove> moves;
  ASSERT_TRUE(paths->path(LiveAxis::kX).moves_of(motion, 20, 0, moves));
  ASSERT_EQ(moves.size(), 1U);
  ASSERT_TRUE(moves[0].arc);
  EXPECT_LT(glm::length(moves[0].arc->center_mm - Vec3(0, 20, -15)), 1e-12);
  EXPECT_LT(glm::length(moves[0].arc->axis - Vec3(0, 1, 0)), 1e-12);
  EXPECT_LT(glm::length(moves[0].axis_from - Vec3(0, 1, 0)), 1e-12);
}

TEST(LivePaths, MachinesThatAreSwitchedAreNotFollowed) {
  const auto machine = [](const char* kinematics) {
    return std::make_shared<const MachineKinematics>(
        known_machine(kinematics, "XYZC", {}, {}).value());
  };
  EXPECT_FALSE(LivePaths::create(machine("millturn"), {}, 0.2));
  EXPECT_FALSE(LivePaths::create(machine("pumakins"), {}, 0.2));
  EXPECT_TRUE(LivePaths::create(machine("trivkins coordinates=XZC"), {}, 0.2));
}

}  // namespace
}  // namespace kerf
