// Chains against poses worked out by hand and against the published formulas.
#include "twin/machine/kinematics/kinematic_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "twin/machine/kinematics/known_kinematics.h"
#include "twin/machines/builtin_models.h"

namespace kerf {
namespace {

constexpr double kRounding_mm = 1e-9;  // a thousandfold of what doubles lose here
constexpr double kRad = kPi / 180.0;

void expect_near(const Vec3& found, const Vec3& wanted, const char* what = "") {
  EXPECT_LT(glm::length(found - wanted), kRounding_mm)
      << what << ": " << found.x << " " << found.y << " " << found.z << ", wanted " << wanted.x
      << " " << wanted.y << " " << wanted.z;
}

ChainLink link(std::string name, std::string parent, JointKind joint, std::uint8_t input,
               Vec3 direction, Vec3 origin = Vec3(0.0)) {
  return {std::move(name), std::move(parent), joint, input, false, direction, origin};
}

MachinePosition at(AxisValues axes) { return {axes, {}}; }

/// Positions from everywhere; the seed is printed where a test fails by the values themselves.
class Positions {
 public:
  MachinePosition next() {
    MachinePosition position;
    for (double& value : position.axes)
      value = std::uniform_real_distribution(-200.0, 200.0)(bits_);
    return position;
  }

 private:
  std::mt19937 bits_{20250711};
};

TEST(KinematicChain, AnArmOfTwoTurnsReachesWhereTrigonometrySays) {
  Result<KinematicChain> arm =
      KinematicChain::create({link("fore", "upper", JointKind::kRotary, 4, {0, 0, 2}, {300, 0, 0}),
                              link("upper", "", JointKind::kRotary, 3, {0, 0, 1}, {10, 20, 30}),
                              link("hand", "fore", JointKind::kFixed, 0, {0, 0, 1}, {200, 0, 5}),
                              link("floor", "", JointKind::kFixed, 0, {0, 0, 1})},
                             "floor", "hand");
  ASSERT_TRUE(arm);
  for (const auto& [a, b] : {std::pair(0.0, 0.0), {30.0, 40.0}, {-120.0, 75.0}, {90.0, 90.0}}) {
    const Pose hand = arm->workpiece_from_tool(at({0, 0, 0, a, b}));
    expect_near(hand.origin_mm,
                Vec3(10 + 300 * std::cos(a * kRad) + 200 * std::cos((a + b) * kRad),
                     20 + 300 * std::sin(a * kRad) + 200 * std::sin((a + b) * kRad), 35));
    expect_near(hand.direction({1, 0, 0}),
                Vec3(std::cos((a + b) * kRad), std::sin((a + b) * kRad), 0));
    // All links at once say the same, children named before their parents too.
    std::vector<Pose> all(4);
    arm->forward(at({0, 0, 0, a, b}), all);
    expect_near(all[2].origin_mm, hand.origin_mm);
  }
}

TEST(KinematicChain, ASlideOnATurnGoesTheTurnedWay) {
  Result<KinematicChain> chain = KinematicChain::create(
      {link("platter", "", JointKind::kRotary, 5, {0, 0, 1}, {5, 0, 0}),
       link("slide", "platter", JointKind::kPrismatic, 0, {3, 0, 4}, {1, 0, 0})},
      "platter", "slide");
  ASSERT_TRUE(chain);
  std::vector<Pose> all(2);
  chain->forward(at({10, 0, 0, 0, 0, 90}), all);
  expect_near(all[1].origin_mm, Vec3(5, 7, 8));  // 1 + 10 * 0.6 along the turned X, 10 * 0.8 up
  // Seen from the platter nothing has turned.
  expect_near(chain->workpiece_from_tool(at({10, 0, 0, 0, 0, 90})).origin_mm, Vec3(7, 0, 8));
}

TEST(KinematicChain, QuarterTurnsAreExact) {
  for (const double turns : {90.0, -90.0, 180.0, 270.0, 36090.0}) {
    const Vec3 turned = turn({0, 0, 1}, turns).direction({1, 0, 0});
    EXPECT_EQ(turned, Vec3(std::round(turned.x), std::round(turned.y), 0)) << turns;
  }
}

TEST(KinematicChain, PosesStayRigidAndInvert) {
  Positions positions;
  const KinematicChain chain = xyzac_trt_chain({3, -4, 5}, 20, 10);
  for (int i = 0; i < 100; ++i) {
    const Pose pose = chain.workpiece_from_tool(positions.next());
    const Vec3 p(1, 2, 3);
    expect_near(pose.inverse().point(pose.point(p)), p);
    EXPECT_NEAR(glm::determinant(pose.rotation), 1.0, 1e-12);
  }
}

TEST(KinematicChain, JointsMoveByNumber) {
  ChainLink slide = link("slide", "", JointKind::kPrismatic, 3, {0, 1, 0});
  slide.by_joint = true;
  Result<KinematicChain> chain = KinematicChain::create(
      {link("floor", "", JointKind::kFixed, 0, {}), slide}, "floor", "slide");
  ASSERT_TRUE(chain);
  const AxisValues axes{1, 2, 3};
  const MachinePosition position{axes, joints_of(axes, "XYYZ")};
  EXPECT_EQ(position.joints, (AxisValues{1, 2, 2, 3}));
  expect_near(chain->workpiece_from_tool(position).origin_mm, Vec3(0, 3, 0));
  EXPECT_FALSE(chain->is_driven_by(3));
}

TEST(KinematicChain, FaultsNameTheLink) {
  const auto fixed = [](const char* name, const char* parent) {
    return link(name, parent, JointKind::kFixed, 0, {0, 0, 1});
  };
  const auto first = [](std::vector<ChainLink> links, const char* workpiece, const char* tool) {
    const std::vector<ChainFault> faults = KinematicChain::faults_of(links, workpiece, tool);
    return faults.empty() ? "" : std::to_string(faults[0].link) + ": " + faults[0].message;
  };
  EXPECT_EQ(first({fixed("a", ""), fixed("b", "a")}, "a", "b"), "");
  EXPECT_EQ(first({fixed("a", ""), fixed("a", "")}, "a", "a"), "1: there are two links 'a'");
  EXPECT_EQ(first({fixed("a", ""), fixed("", "a")}, "a", "a"), "1: a link needs a name");
  EXPECT_EQ(first({fixed("a", "bas"), fixed("base", "")}, "a", "a"),
            "0: 'bas' is no link; there are a, base");
  EXPECT_EQ(first({fixed("a", "b"), fixed("b", "a")}, "a", "b"),
            "0: 'a' hangs on itself, by way of 'b'; one link of the circle must have no parent");
  EXPECT_EQ(first({link("a", "", JointKind::kRotary, 3, {0, 0, 0})}, "a", "a"),
            "0: a direction of no length points nowhere");
  EXPECT_EQ(first({fixed("a", "")}, "b", "a"), "0: 'b' is no link; there are a");
  const Result<KinematicChain> none = KinematicChain::create({fixed("a", "")}, "a", "head");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error(), "'head' is no link; there are a");
}

/// With trivial kinematics the controlled point is where X, Y and Z say, whatever part moves.
TEST(TrivialKinematics, ThePointIsWhereTheAxesSay) {
  Positions positions;
  for (const MachineKind kind :
       {MachineKind::kKneeMill, MachineKind::kGantry, MachineKind::kLathe, MachineKind::kTrunnion,
        MachineKind::kPlasma, MachineKind::kPunch}) {
    MachineRoom room;
    room.machine_from_workpiece = shift({7, -8, 9}) * turn({0, 0, 1}, 30);
    if (kind == MachineKind::kLathe) room.machine_from_workpiece = shift({0, 0, 9});
    const MachineModel model = builtin_machine(kind, room);
    for (int i = 0; i < 20; ++i) {
      AxisValues axes = positions.next().axes;
      for (std::size_t turned = 3; turned < 9; ++turned) axes[turned] = 0;
      if (kind == MachineKind::kLathe) axes[1] = 0;
      const Vec3 wanted(axes[0], axes[1], axes[2]);
      const MachinePosition position = position_of_axes(model, axes, 87.5);
      const ToolStand tool = tool_stand(model, position, 87.5);
      expect_near(tool.tip_mm, wanted, model.name.c_str());
      const std::optional<MachinePosition> solved = position_of_tip(model, axes, 87.5);
      ASSERT_TRUE(solved) << model.name;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(solved->axes[axis], position.axes[axis], 1e-8) << model.name;
      }
    }
  }
}

TEST(TrivialKinematics, ATrunnionTurnsThePartAwayUnderStandingAxes) {
  MachineRoom room;
  room.blank_mm = {{-20, -20, -40}, {20, 20, 0}};
  room.trunnion.rotation_point_mm = Vec3(0, 0, 0);
  const MachineModel model = builtin_machine(MachineKind::kTrunnion, room);
  // A table turned right-handed by 90 degrees about X brings what was at +Y up to +Z: the point
  // above the pivot is, in the part, at +Y.
  expect_near(tool_stand(model, position_of_axes(model, {0, 0, 10, 90}, 50), 50).tip_mm,
              Vec3(0, 10, 0));
  expect_near(tool_stand(model, position_of_axes(model, {0, 0, 10, 90}, 50), 50).axis,
              Vec3(0, 1, 0));
  // C after it, about the part's own axis.
  expect_near(tool_stand(model, position_of_axes(model, {0, 0, 10, 90, 0, 90}, 50), 50).tip_mm,
              Vec3(10, 0, 0));
  room.trunnion.tilts_about_y = true;
  const MachineModel other = builtin_machine(MachineKind::kTrunnion, room);
  expect_near(tool_stand(other, position_of_axes(other, {0, 0, 10, 0, 90}, 50), 50).tip_mm,
              Vec3(-10, 0, 0));
}

/// The forward formulas of LinuxCNC's manual, chapter "5-Axis Kinematics", with the modules' pins:
/// joint values to X Y Z of the part. A tool offset moves the tilting axis up and the result too.
TEST(KnownKinematics, XyzacTrtAgreesWithThePublishedFormulas) {
  const Vec3 r(11, -7, 23);
  const double oy = 20;
  const double oz = 10;
  const KinematicChain chain = xyzac_trt_chain(r, oy, oz);
  Positions positions;
  for (int i = 0; i < 200; ++i) {
    const MachinePosition position = positions.next();
    const double tool = 35.5 * (i % 3);
    const double a = position.axes[3] * kRad;
    const double c = position.axes[5] * kRad;
    const double x = position.axes[0] - r.x;
    const double y = position.axes[1] - oy - r.y;
    const double z = position.axes[2] - (oz + tool) - r.z;
    const double level = std::cos(a) * y + std::sin(a) * z + oy;
    const Vec3 formula(std::cos(c) * x + std::sin(c) * level + r.x,
                       -std::sin(c) * x + std::cos(c) * level + r.y,
                       -std::sin(a) * y + std::cos(a) * z + oz + tool + r.z);
    // The modules count to the tip and add the tool's length to Z.
    expect_near(chain.workpiece_from_tool(position).point({0, 0, -tool}) + Vec3(0, 0, tool),
                formula);
  }
}

TEST(KnownKinematics, XyzbcTrtAgreesWithThePublishedFormulas) {
  const Vec3 r(-5, 12, 40);
  const double ox = 15;
  const double oz = -8;
  const KinematicChain chain = xyzbc_trt_chain(r, ox, oz);
  Positions positions;
  for (int i = 0; i < 200; ++i) {
    const MachinePosition position = positions.next();
    const double tool = 20.25 * (i % 3);
    const double b = position.axes[4] * kRad;
    const double c = position.axes[5] * kRad;
    const double x = position.axes[0] - ox - r.x;
    const double y = position.axes[1] - r.y;
    const double z = position.axes[2] - (oz + tool) - r.z;
    const double level = std::cos(b) * x - std::sin(b) * z + ox;
    const Vec3 formula(std::cos(c) * level + std::sin(c) * y + r.x,
                       -std::sin(c) * level + std::cos(c) * y + r.y,
                       std::sin(b) * x + std::cos(b) * z + oz + tool + r.z);
    expect_near(chain.workpiece_from_tool(position).point({0, 0, -tool}) + Vec3(0, 0, tool),
                formula);
  }
}

TEST(KnownKinematics, BridgeMillAgreesWithThePublishedFormulas) {
  const double pivot = 250;
  const KinematicChain chain = bridge_5axis_chain(pivot);
  Positions positions;
  for (int i = 0; i < 200; ++i) {
    const MachinePosition position = positions.next();
    const AxisValues& j = position.axes;
    const double b = j[4] * kRad;
    const double c = j[5] * kRad;
    const double reach = pivot + j[8];
    const Pose tool = chain.workpiece_from_tool(position);
    expect_near(tool.origin_mm,
                Vec3(j[0] + reach * std::sin(b) * std::cos(c),
                     j[1] + reach * std::sin(b) * std::sin(c), j[2] - reach * std::cos(b) + pivot));
    expect_near(tool.direction({0, 0, -1}),
                Vec3(std::sin(b) * std::cos(c), std::sin(b) * std::sin(c), -std::cos(b)));
  }
}

TEST(PositionOfTip, PutsTheTipOnThePartWhateverTurns) {
  MachineRoom room;
  room.machine_from_workpiece = shift({40, 50, -60}) * turn({0, 0, 1}, 15);
  room.trunnion.side_offset_mm = 20;
  room.trunnion.z_offset_mm = 10;
  const MachineModel model = builtin_machine(MachineKind::kTrunnion, room);
  Positions positions;
  for (int i = 0; i < 100; ++i) {
    const AxisValues program = positions.next().axes;
    const std::optional<MachinePosition> position = position_of_tip(model, program, 72);
    ASSERT_TRUE(position);
    expect_near(tool_stand(model, *position, 72).tip_mm, Vec3(program[0], program[1], program[2]));
    EXPECT_EQ(position->axes[3], program[3]);
  }
}

TEST(PositionOfTip, NothingWhereSlidesAreParallel) {
  Result<KinematicChain> chain =
      KinematicChain::create({link("bed", "", JointKind::kFixed, 0, {}),
                              link("x", "", JointKind::kPrismatic, 0, {1, 0, 0}),
                              link("y", "x", JointKind::kPrismatic, 1, {1, 0, 0})},
                             "bed", "y");
  ASSERT_TRUE(chain);
  MachineModel model{"", *chain, {}, {}};
  EXPECT_FALSE(position_of_tip(model, {1, 2, 3}, 0));
  Result<KinematicChain> rigid =
      KinematicChain::create({link("bed", "", JointKind::kFixed, 0, {})}, "bed", "bed");
  ASSERT_TRUE(rigid);
  EXPECT_FALSE(position_of_tip({"", *rigid, {}, {}}, {1, 2, 3}, 0));
}

}  // namespace
}  // namespace kerf
