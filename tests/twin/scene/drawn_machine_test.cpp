#include "twin/scene/drawn_machine.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <memory>

#include "twin/machine/kinematics/tool_path.h"
#include "twin/machines/builtin_models.h"

namespace kerf {
namespace {

constexpr double kToolLength_mm = 60;

ToolPath path_of(const char* kinematics, const char* letters) {
  MachineKinematics machine = known_machine(kinematics, letters, {}, {}).value();
  return std::move(ToolPath::create(std::move(machine), {}, {}).value());
}

Motion feed_to(const Vec3& to_mm, const std::array<double, 3>& abc_deg) {
  Motion m;
  m.kind = MotionKind::kFeed;
  m.to_mm = to_mm;
  m.from_abc_deg = m.to_abc_deg = abc_deg;
  return m;
}

MachineModel machine_around_a_block(MachineKind kind) {
  MachineRoom room;
  room.blank_mm.extend(Vec3(-40, -30, 0));
  room.blank_mm.extend(Vec3(40, 30, 35));
  return builtin_machine(kind, room);
}

/// The nose of the machine that is drawn, where the tool's upper end is.
void expect_nose_at_the_tool(const MachineModel& machine, const ToolPath& path, const Motion& m) {
  const Pose tool = path.pose_at(m, 1);
  const auto poses = drawn_poses(machine, tool, m.to_abc_deg, kToolLength_mm);
  ASSERT_EQ(poses.size(), machine.links.size());
  const glm::mat4& nose = poses[machine.chain.tool_link()];
  const Vec3 up = path.spindle_at(m, 1);
  EXPECT_LT(glm::length(Vec3(nose[3]) - (tool.origin_mm + kToolLength_mm * up)), 1e-3);
  EXPECT_LT(glm::length(Vec3(nose[2]) - up), 1e-5);
}

TEST(DrawnMachine, TheViewerIsGivenEachLinkAsItIs) {
  const MachineModel model = machine_around_a_block(MachineKind::kGantry);
  const SceneMachine scene = scene_machine(model);
  EXPECT_EQ(scene.name, "gantry router");
  ASSERT_EQ(scene.links.size(), model.links.size());
  for (std::size_t i = 0; i < scene.links.size(); ++i) {
    EXPECT_EQ(scene.links[i].name, model.links[i].name);
    EXPECT_EQ(scene.links[i].mesh, model.links[i].mesh) << "shared, not copied";
    EXPECT_EQ(scene.links[i].color, model.links[i].color);
  }
}

TEST(DrawnMachine, StandsWhereTheKinematicsHaveTheTool) {
  const MachineModel trunnion = machine_around_a_block(MachineKind::kTrunnion);
  for (const char* kinematics : {"xyzac-trt-kins", "trivkins"}) {
    SCOPED_TRACE(kinematics);
    const ToolPath path = path_of(kinematics, "XYZAC");
    for (const auto& abc : {std::array{0.0, 0.0, 0.0}, std::array{-40.0, 0.0, 0.0},
                            std::array{0.0, 0.0, 75.0}, std::array{30.0, 0.0, -110.0}}) {
      expect_nose_at_the_tool(trunnion, path, feed_to({10, -20, 40}, abc));
    }
  }
}

/// Heads that tilt: B and C are those of LinuxCNC's kinematics for such machines, and W goes along
/// the tool.
TEST(DrawnMachine, HeadsTiltAsTheKinematicsHaveThem) {
  const std::pair<const char*, MachineKind> machines[] = {{"5axiskins", MachineKind::kBridgeMill},
                                                          {"maxkins", MachineKind::kSwivelMill}};
  for (const auto& [kinematics, kind] : machines) {
    SCOPED_TRACE(kinematics);
    const MachineModel machine = machine_around_a_block(kind);
    const ToolPath path = path_of(kinematics, "");
    for (const auto& abc : {std::array{0.0, 0.0, 0.0}, std::array{0.0, -40.0, 0.0},
                            std::array{0.0, 0.0, 75.0}, std::array{0.0, 30.0, -110.0}}) {
      Motion m = feed_to({10, -20, 40}, abc);
      expect_nose_at_the_tool(machine, path, m);
      m.from_uvw_mm = m.to_uvw_mm = {0, 0, 7};
      expect_nose_at_the_tool(machine, path, m);
      EXPECT_LT(glm::length(path.pose_at(m, 1).origin_mm - (m.to_mm + 7.0 * path.spindle_at(m, 1))),
                1e-9);
    }
  }
}

TEST(DrawnMachine, IsNotThereWhileItCannotTurnAsTheProgramDoes) {
  const MachineModel mill = machine_around_a_block(MachineKind::kKneeMill);
  const ToolPath path = path_of("trivkins", "XYZA");
  expect_nose_at_the_tool(mill, path, feed_to({10, -20, 40}, {0, 0, 0}));
  const Motion turned = feed_to({10, -20, 40}, {30, 0, 0});
  EXPECT_TRUE(
      drawn_poses(mill, path.pose_at(turned, 1), turned.to_abc_deg, kToolLength_mm).empty());
}

}  // namespace
}  // namespace kerf
