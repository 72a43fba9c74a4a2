#include "twin/machine/kinematics/switched_motions.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// Motions as an interpreter has them that knows nothing of kinematics.
class Interpreter {
 public:
  explicit Interpreter(double tool_mm = 0) { state_.tool_offset_mm = {0, 0, tool_mm}; }
  void type(int number) { state_.torch.analog[3] = static_cast<float>(number); }
  void go(Vec3 to, std::array<double, 3> abc_deg) {
    state_.kind = MotionKind::kFeed;
    state_.from_mm = state_.to_mm;
    state_.from_abc_deg = state_.to_abc_deg;
    state_.to_mm = to;
    state_.to_abc_deg = abc_deg;
    list.push_back(state_);
  }
  /// Words for A, B, C alone.
  void turn(std::array<double, 3> abc_deg) { go(state_.to_mm, abc_deg); }
  void dwell() {
    Motion m = state_;
    m.kind = MotionKind::kDwell;
    m.from_mm = m.to_mm;
    list.push_back(m);
  }
  std::vector<Motion> list;

 private:
  Motion state_;
};

std::shared_ptr<const MachineKinematics> trunnion() {
  return std::make_shared<const MachineKinematics>(
      known_machine("xyzac-trt-kins sparm=identityfirst", "", {}, {}).value());
}

/// At X10, C90 under identity: in the part the tip is at Y-10 (of the right-handed table).
Interpreter switching() {
  Interpreter program;
  program.go({10, 0, 5}, {});
  program.turn({0, 0, 90});
  program.type(1);
  program.dwell();
  program.turn({0, 0, 0});     // no word for X, Y, Z: stays on the part
  program.go({10, 4, 5}, {});  // Y4
  program.go({3, 4, 1}, {});   // X3 Z1
  return program;
}

TEST(SwitchedMotions, AMachineStaysWhereItIsUntilItsAxesAreNamed) {
  const Interpreter program = switching();
  SwitchedMotions switched(trunnion());
  const std::span<const Motion> seen = switched.follow(program.list, {});
  ASSERT_EQ(seen.size(), program.list.size());
  EXPECT_EQ(seen[1].to_mm, Vec3(10, 0, 5));
  const auto near = [](const Vec3& a, const Vec3& b) { return glm::length(a - b) < 1e-9; };
  EXPECT_TRUE(near(seen[3].from_mm, {0, -10, 5})) << seen[3].from_mm.x << " " << seen[3].from_mm.y;
  EXPECT_TRUE(near(seen[3].to_mm, {0, -10, 5}));
  EXPECT_TRUE(near(seen[4].from_mm, {0, -10, 5}));
  EXPECT_TRUE(near(seen[4].to_mm, {0, 4, 5}));
  EXPECT_TRUE(near(seen[5].from_mm, {0, 4, 5}));
  EXPECT_TRUE(near(seen[5].to_mm, {3, 4, 1}));
  // The tool does not jump: every motion begins on the part where the one before ended.
  const auto path = ToolPath::create(*trunnion(), {}, {});
  for (const std::size_t i : {1U, 3U, 4U, 5U}) {
    const Motion& before = seen[i == 3 ? 1 : i - 1];
    EXPECT_TRUE(near(path->pose_at(seen[i], 0).origin_mm, path->pose_at(before, 1).origin_mm)) << i;
  }
}

/// What a LinuxCNC 2.9.0 did with "G1 C40, M428, G1 C0, G1 Y6, G1 X8, G1 A-20 C20, M429, G1 X0,
/// G1 Z8" from X-10 Y0 Z-2, G54 at X20 Y-10 Z-40, a tool of 35 mm: its joints, where it stood.
TEST(SwitchedMotions, AsLinuxCncDoes) {
  const auto machine = std::make_shared<const MachineKinematics>(
      known_machine("xyzac-trt-kins sparm=identityfirst", "",
                    {{"x-rot-point", 10},
                     {"y-rot-point", -5},
                     {"z-rot-point", 20},
                     {"y-offset", 4},
                     {"z-offset", 12}},
                    {})
          .value());
  WorkpieceFrame work;
  work.g5x_mm = {20, -10, -40};
  Interpreter program(35);
  program.go({-10, 0, -2}, {});
  program.turn({0, 0, 40});
  program.type(1);
  program.turn({0, 0, 0});
  program.go({-10, 6, -2}, {});
  program.go({8, 6, -2}, {});
  program.turn({-20, 0, 20});
  program.type(0);
  program.go({0, 6, -2}, {-20, 0, 20});
  program.go({0, 6, 8}, {-20, 0, 20});
  SwitchedMotions switched(machine);
  const std::span<const Motion> seen = switched.follow(program.list, work);
  const auto path = ToolPath::create(*machine, work, {});
  const auto joints_after = [&](std::size_t i) {
    const AxisValues j = path->machine_at(seen[i], 1).value_or(MachinePosition{}).joints;
    return Vec3(j[0], j[1], j[2]);
  };
  const auto near = [](const Vec3& a, const Vec3& b) { return glm::length(a - b) < 2e-4; };
  EXPECT_TRUE(near(joints_after(1), {10, -10, -7}));
  EXPECT_TRUE(near(joints_after(5), {26.5724, -23.4002, -3.5962}));
  EXPECT_TRUE(near(joints_after(7), {20, -23.4002, 3}));
}

TEST(SwitchedMotions, BatchesDoNotMatter) {
  const Interpreter program = switching();
  SwitchedMotions whole(trunnion()), single(trunnion());
  const std::span<const Motion> seen = whole.follow(program.list, {});
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Motion one = single.follow({&program.list[i], 1}, {}).front();
    EXPECT_EQ(one.from_mm, seen[i].from_mm) << i;
    EXPECT_EQ(one.to_mm, seen[i].to_mm) << i;
  }
}

TEST(SwitchedMotions, WhereNothingIsTurnedNothingChanges) {
  Interpreter program;
  program.go({10, 0, 5}, {});
  program.type(1);
  program.go({10, 8, 5}, {});
  SwitchedMotions switched(trunnion());
  EXPECT_EQ(switched.follow(program.list, {}).data(), program.list.data());
  SwitchedMotions plain(nullptr);
  const Interpreter turning = switching();
  EXPECT_EQ(plain.follow(turning.list, {}).data(), turning.list.data());
}

}  // namespace
}  // namespace kerf
