// machine.kinematics and what belongs to it.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/twin/config/config_support.h"
#include "twin/machine/kinematics/tool_path.h"

namespace kerf {
namespace {

TEST(ConfigKinematics, ValuesArriveAndArePrintedAgain) {
  const ReadText read(
      "machine:\n"
      "  kinematics: xyzac-trt-kins sparm=identityfirst\n"
      "  geometry: {y-offset: 20, x-rot-point: -3.5}\n"
      "  told_tool_length: 0\n"
      "  work_offset: {z: 5, a: 30, c: -90}\n");
  ASSERT_TRUE(read.config) << read.said();
  const KinematicsRequest& request = *read.config->machine.kinematics;
  EXPECT_EQ(request.kinematics, "xyzac-trt-kins sparm=identityfirst");
  EXPECT_EQ(request.geometry.at("y-offset"), 20);
  EXPECT_EQ(request.geometry.at("x-rot-point"), -3.5);
  EXPECT_EQ(request.told_tool_mm, 0);
  EXPECT_EQ(read.config->machine.work_offset->offset_abc_deg, (std::array<double, 3>{30, 0, -90}));
  const std::string printed = effective_yaml(*read.config);
  const ReadText again(printed);
  ASSERT_TRUE(again.config) << again.said() << printed;
  EXPECT_EQ(effective_yaml(*again.config), printed);
  EXPECT_EQ(again.config->machine.kinematics->geometry, request.geometry);

  const ReadText table(
      "machine: {joints: XYZA, kinematics: trivkins, rotary_side: head, rotary_center: '1,2,3'}\n");
  ASSERT_TRUE(table.config) << table.said();
  EXPECT_EQ(table.config->machine.kinematics->rotary_side, RotarySide::kHead);
  EXPECT_EQ(table.config->machine.kinematics->rotary_center_mm, Vec3(1, 2, 3));
  EXPECT_EQ(effective_yaml(*ReadText(effective_yaml(*table.config)).config),
            effective_yaml(*table.config));
}

constexpr const char* kLinks =
    "  workpiece_on: table\n"
    "  tool_on: quill\n"
    "  links:\n"
    "    - {name: table, axis: X, direction: '-1,0,0', origin: '0,0,-100'}\n"
    "    - {name: column, axis: Y}\n"
    "    - {name: head, parent: column, axis: Z, origin: '0,0,300'}\n"
    "    - {name: fork, parent: head, axis: B, direction: '0,1,0', origin: '0,0,-50'}\n"
    "    - {name: quill, parent: fork, origin: '0,0,-120'}\n";

TEST(ConfigKinematics, AnyChainOfLinks) {
  for (const bool follows : {false, true}) {
    const ReadText read(fmt::format("machine:\n  kinematics: links\n  follows_tip: {}\n{}",
                                    follows ? "yes" : "no", kLinks));
    ASSERT_TRUE(read.config) << read.said();
    EXPECT_EQ(effective_yaml(*ReadText(effective_yaml(*read.config)).config),
              effective_yaml(*read.config));
    const auto machine = kinematics_of_request(*read.config->machine.kinematics, "");
    ASSERT_TRUE(machine) << machine.error();
    EXPECT_EQ(machine->joint_letters, "XYZB");
    const auto path = ToolPath::create(*machine, {}, {});
    ASSERT_TRUE(path);
    // At rest machine zero is where the tool is; B turns it about a point 120 mm above.
    Motion there;
    there.start_known = false;
    there.to_mm = {10, 20, 30};
    EXPECT_LT(glm::length(path->pose_at(there, 1).origin_mm - there.to_mm), 1e-9);
    there.to_abc_deg[1] = there.from_abc_deg[1] = 90;
    const Vec3 tip = path->pose_at(there, 1).origin_mm;
    const Vec3 wanted = follows ? Vec3(10, 20, 30) : Vec3(10 - 120, 20, 30 + 120);
    EXPECT_LT(glm::length(tip - wanted), 1e-9) << tip.x << " " << tip.y << " " << tip.z;
    EXPECT_LT(glm::length(path->spindle_at(there, 1) - Vec3(1, 0, 0)), 1e-9);
    // Forward and inverse agree.
    const auto stands = path->machine_at(there, 1);
    ASSERT_TRUE(stands);
    const AxisValues axes = machine->axes_of(stands->joints, 0);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(axes[static_cast<std::size_t>(i)], there.to_mm[i], 1e-9);
  }
}

TEST(ConfigKinematics, FaultsStandWhereTheyAre) {
  EXPECT_NE(
      said_of("machine:\n  kinematics: hexapod\n").find("2:15: machine.kinematics: hexapod is "),
      std::string::npos)
      << said_of("machine:\n  kinematics: hexapod\n");
  EXPECT_EQ(said_of("machine:\n  kinematics: 5axiskins\n  geometry: {y-offset: 3}\n"),
            "3:14: machine.geometry.y-offset: is no number of 5axiskins; it takes pivot-length\n");
  EXPECT_EQ(said_of("machine:\n  geometry: {y-ofset: 3}\n"),
            "2:14: machine.geometry.y-ofset: unknown key (did you mean y-offset?)\n");
  EXPECT_EQ(said_of("machine:\n  kinematics: links\n"),
            "2:15: machine.kinematics: there are no links (machine.links lists them)\n");
  EXPECT_EQ(said_of("machine:\n  follows_tip: yes\n"),
            "2:3: machine.follows_tip: has no place here: only `kinematics: links` has it\n");
  EXPECT_EQ(said_of("machine:\n  kinematics: maxkins\n  rotary_side: table\n"),
            "3:3: machine.rotary_side: has no place here: maxkins says what turns, and where\n");
  EXPECT_EQ(
      said_of(fmt::format("machine:\n  kinematics: links\n  geometry: {{D1: 3}}\n{}", kLinks)),
      "3:3: machine.geometry: has no place here: the links say where everything is\n");
  EXPECT_EQ(
      said_of("machine:\n  rotary_center: 1,2\n"),
      "2:18: machine.rotary_center: '1,2' is not allowed; must be three numbers, x,y,z (as in "
      "0,0,-120.5)\n");
}

TEST(ConfigKinematics, LinksThatCannotFollowAreRefused) {
  const std::string said = said_of(
      "machine:\n  kinematics: links\n  follows_tip: yes\n  workpiece_on: table\n  tool_on: head\n"
      "  links:\n    - {name: table, axis: X, direction: '-1,0,0'}\n"
      "    - {name: cross, axis: Y}\n    - {name: head, parent: cross, axis: Z, direction: "
      "'0,1,0'}\n");
  EXPECT_NE(said.find("2:15: machine.kinematics: "), std::string::npos) << said;
}

}  // namespace
}  // namespace kerf
