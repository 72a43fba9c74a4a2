// The machine on a motion against the kinematics themselves, and the bounds on its links' ways
// against what is seen of them.
#include "twin/machines/machine_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "twin/machine/kinematics/kinematics_setup.h"

namespace kerf {
namespace {

struct Case {
  const char* name;
  MachineKinematics machine;
};

ChainLink link(const char* name, const char* parent, JointKind joint, std::uint8_t input,
               const Vec3& direction, const Vec3& origin_mm = Vec3(0.0)) {
  ChainLink out;
  out.name = name;
  out.parent = parent;
  out.joint = joint;
  out.input = input;
  out.direction = direction;
  out.origin_mm = origin_mm;
  return out;
}

/// A table in X that turns about Z, a head in Y and Z that swivels about Y; the tip is followed.
MachineKinematics swivel_head() {
  LinkedKinematics linked;
  linked.links = {link("frame", "", JointKind::kFixed, 0, {0, 0, 1}),
                  link("table", "frame", JointKind::kPrismatic, 0, {-1, 0, 0}),
                  link("platter", "table", JointKind::kRotary, 5, {0, 0, -1}, {10, -20, -30}),
                  link("saddle", "frame", JointKind::kPrismatic, 1, {0, 1, 0}),
                  link("ram", "saddle", JointKind::kPrismatic, 2, {0, 0, 1}),
                  link("fork", "ram", JointKind::kRotary, 4, {0, 1, 0}, {0, 0, 80}),
                  link("nose", "fork", JointKind::kFixed, 0, {0, 0, 1}, {0, 0, -80})};
  linked.workpiece_on = "platter";
  linked.tool_on = "nose";
  linked.follows_tip = true;
  return kinematics_of_links(linked, "XYZBC").value();
}

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const char* module : {"trivkins", "xyzac-trt-kins", "5axiskins", "maxkins"})
    out.push_back({module, known_machine(module, "XYZABC", {}, {}).value()});
  out.push_back({"swivel head", swivel_head()});
  return out;
}

WorkpieceFrame a_frame() {
  WorkpieceFrame frame;
  frame.g5x_mm = {12, -34, -156};
  frame.rotation_deg = 17;
  frame.offset_abc_deg = {3, -5, 20};
  return frame;
}

Motion random_motion(std::mt19937& random, bool turns) {
  std::uniform_real_distribution<double> draw(-1, 1);
  Motion m;
  m.kind = MotionKind::kFeed;
  for (int i = 0; i < 3; ++i) {
    m.from_mm[i] = 120 * draw(random);
    m.to_mm[i] = m.from_mm[i] + 80 * draw(random);
    const auto axis = static_cast<std::size_t>(i);
    m.from_abc_deg[axis] = 40 * draw(random);
    m.to_abc_deg[axis] = m.from_abc_deg[axis] + (turns ? 50 * draw(random) : 0);
  }
  m.tool_offset_mm = {0, 0, 60 + 20 * draw(random)};
  if (draw(random) > 0.3) {
    m.kind = MotionKind::kArc;
    m.arc.center_mm = m.from_mm + Vec3{30 * draw(random), 30 * draw(random), 0};
    m.arc.axis = {0, 0, 1};
    m.arc.sweep_rad = 4 * draw(random);
    // Its radius grows a little, and it climbs.
    const double s = std::sin(m.arc.sweep_rad), c = std::cos(m.arc.sweep_rad);
    const Vec3 arm = (1 + 0.1 * draw(random)) * (m.from_mm - m.arc.center_mm);
    m.to_mm =
        m.arc.center_mm + Vec3(c * arm.x - s * arm.y, s * arm.x + c * arm.y, 20 * draw(random));
  }
  return m;
}

TEST(MachineRun, StandsWhereTheKinematicsSend) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    std::mt19937 random(7);
    const MachineRuns runs = MachineRuns::create(one.machine, a_frame()).value();
    MachineRun run;
    for (int i = 0; i < 50; ++i) {
      const Motion m = random_motion(random, true);
      ASSERT_TRUE(runs.knows(m));
      runs.follow(m, 0, run);
      for (const double t : {0.0, 0.37, 1.0}) {
        const auto sent = runs.path().machine_at(m, t);
        ASSERT_TRUE(sent);
        const AxisValues axes = run.axes_at(t);
        for (std::size_t axis = 0; axis < kAxisCount; ++axis)
          EXPECT_NEAR(axes[axis], sent->axes[axis], 1e-8) << axis;
      }
    }
  }
}

/// Without an offset the tool hangs below the nose all the same, and its tip is where the program
/// has it, however the head is turned.
TEST(MachineRun, AToolWithoutAnOffsetHangsBelowTheNose) {
  const MachineKinematics machine = swivel_head();
  const MachineRuns runs = MachineRuns::create(machine, a_frame()).value();
  std::mt19937 random(11);
  MachineRun run;
  Motion m = random_motion(random, true);
  m.tool_offset_mm = Vec3(0.0);
  runs.follow(m, 75, run);
  MachinePosition position;
  position.axes = run.axes_at(0.6);
  const Pose tool = machine.chain.workpiece_from_tool(position);
  const Vec3 tip =
      runs.path().link_from_workpiece().inverse().point(tool.point(runs.tip_from_nose(m, 75)));
  EXPECT_LT(glm::distance(tip, runs.path().pose_at(m, 0.6).origin_mm), 1e-8);
}

TEST(MachineRun, AxesStayWithinTheirSpanAndTheirBounds) {
  constexpr double kStep = 1e-4;
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    std::mt19937 random(5);
    const MachineRuns runs = MachineRuns::create(one.machine, a_frame()).value();
    MachineRun run;
    for (int i = 0; i < 40; ++i) {
      const Motion m = random_motion(random, i % 4 != 0);
      runs.follow(m, 0, run);
      for (double t = kStep; t < 1 - kStep; t += 0.02) {
        const AxisValues before = run.axes_at(t - kStep), here = run.axes_at(t),
                         after = run.axes_at(t + kStep);
        for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
          const double room = 1e-6 * (1 + std::abs(here[axis]));
          EXPECT_GE(here[axis], run.span().low[axis] - room) << axis;
          EXPECT_LE(here[axis], run.span().high[axis] + room) << axis;
          const double rate = std::abs(after[axis] - before[axis]) / (2 * kStep);
          const double bend =
              std::abs(after[axis] - 2 * here[axis] + before[axis]) / (kStep * kStep);
          EXPECT_LE(rate, run.bounds().rate[axis] * (1 + 1e-6) + 1e-5) << axis;
          EXPECT_LE(bend, run.bounds().acceleration[axis] * (1 + 1e-3) + 0.05) << axis;
        }
      }
    }
  }
}

/// Any link as any other sees it.
TEST(LinkWay, NoPointIsOutsideOfHullAndSlack) {
  std::uniform_real_distribution<double> draw(-1, 1);
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    std::mt19937 random(13);
    const KinematicChain& chain = one.machine.chain;
    const MachineRuns runs = MachineRuns::create(one.machine, a_frame()).value();
    MachineRun run;
    std::uniform_int_distribution<std::size_t> any(0, chain.links().size() - 1);
    for (int i = 0; i < 150; ++i) {
      const Motion m = random_motion(random, i % 3 != 0);
      runs.follow(m, 0, run);
      const ToolChain steps(chain, one.machine.joint_letters, any(random), any(random));
      const Pose body = shift({90 * draw(random), 90 * draw(random), 90 * draw(random)});
      const Pose still = turn(glm::normalize(Vec3{draw(random), draw(random), 1.5}), 30);
      const LinkWay way(run, steps, still, body);
      const double reach = 40;
      const Vec3 p = reach * glm::normalize(Vec3{draw(random), draw(random), draw(random)});
      const double from = 0.4 * (1 + draw(random)), to = from + 0.2;
      const Vec3 a = way.pose(from).point(p), b = way.pose(to).point(p);
      const double slack = way.slack_mm(from, to, reach), travel = way.travel_mm(from, to, reach);
      for (int k = 1; k < 20; ++k) {
        const double share = k / 20.0;
        const Vec3 here = way.pose(from + share * (to - from)).point(p);
        // The chord belongs to the hull of both places.
        EXPECT_LE(glm::distance(here, a + share * (b - a)), slack + 1e-9);
        EXPECT_LE(glm::distance(here, a), travel + 1e-9);
      }
    }
  }
}

TEST(LinkWay, NoPointGoesFartherThanTheSpanAllows) {
  std::uniform_real_distribution<double> draw(-1, 1);
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    std::mt19937 random(17);
    const KinematicChain& chain = one.machine.chain;
    const MachineRuns runs = MachineRuns::create(one.machine, a_frame()).value();
    MachineRun first, run;
    std::uniform_int_distribution<std::size_t> any(0, chain.links().size() - 1);
    for (int i = 0; i < 150; ++i) {
      const Motion before = random_motion(random, true), m = random_motion(random, i % 3 != 0);
      runs.follow(before, 0, first);
      runs.follow(m, 0, run);
      const AxisValues seen_at = first.axes_at(1);
      const ToolChain steps(chain, one.machine.joint_letters, any(random), any(random));
      const Vec3 end{50 * draw(random), 50 * draw(random), 50 * draw(random)};
      const double reach = 30;
      const double most = most_way_mm(steps, seen_at, run.span(), end, reach);
      const Vec3 p = end + reach * glm::normalize(Vec3{draw(random), draw(random), draw(random)});
      const Vec3 was = steps.pose(seen_at).point(p);
      for (int k = 0; k <= 20; ++k)
        EXPECT_LE(glm::distance(steps.pose(run.axes_at(k / 20.0)).point(p), was), most + 1e-9);
    }
  }
}

/// A machine that it cannot follow says so.
TEST(MachineRun, RobotsAndSlidesThatTurnAreNotKnown) {
  const MachineRuns robot =
      MachineRuns::create(known_machine("pumakins", "XYZABC", {}, {}).value(), {}).value();
  EXPECT_FALSE(robot.knows(Motion{}));
  LinkedKinematics linked;
  linked.links = {link("frame", "", JointKind::kFixed, 0, {0, 0, 1}),
                  link("slide", "frame", JointKind::kPrismatic, 0, {1, 0, 0}),
                  link("swivel", "slide", JointKind::kRotary, 5, {0, 0, 1}),
                  link("arm", "swivel", JointKind::kPrismatic, 1, {0, 1, 0}),
                  link("quill", "arm", JointKind::kPrismatic, 2, {0, 0, 1})};
  linked.workpiece_on = "frame";
  linked.tool_on = "quill";
  linked.follows_tip = true;
  const Result<MachineKinematics> machine = kinematics_of_links(linked, "XYZC");
  ASSERT_TRUE(machine);
  EXPECT_FALSE(MachineRuns::create(*machine, {}).value().knows(Motion{}));
}

}  // namespace
}  // namespace kerf
