// Kinematics as INI, HAL files and the configuration have them.
#include "twin/machine/kinematics/kinematics_setup.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace kerf {
namespace {

namespace fs = std::filesystem;

class KinematicsSetup : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "kerf-kins.XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  void hal(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Result<MachineKinematics> read(const std::string& ini_text, const KinematicsRequest& request = {},
                                 double unit_mm = 1, std::string_view letters = "XYZA") const {
    Diagnostics said;
    IniFile ini = IniFile::parse(ini_text, "m.ini", {}, said);
    return kinematics_of_ini(ini, folder_.string(), letters, unit_mm, request);
  }
  /// Y of the tip that the module sees with A at 90 degrees.
  static double tilted_y(const MachineKinematics& machine, int type) {
    return machine.axes_of({0, 0, 0, 90}, type)[1];
  }

  fs::path folder_;
};

TEST_F(KinematicsSetup, NumbersComeFromHalWhereTheyAreWrittenDown) {
  hal("a.hal",
      "# a comment\n"
      "setp xyzac-trt-kins.z-rot-point [TABLE]HEIGHT   # of the platter\n"
      "setp xyzac-trt-kins.\\\n"
      "x-rot-point 3\n"
      "net :tool motion.tooloffset.z => xyzac-trt-kins.tool-offset gui.tool\n");
  const auto machine = read(
      "[KINS]\nKINEMATICS = xyzac-trt-kins sparm=identityfirst\n[TABLE]\nHEIGHT = -7.5\n[HAL]\n"
      "HALFILE = LIB:basic_sim.tcl\nHALFILE = a.hal\n"
      "HALCMD = net :y-offset xyzac-trt-kins.y-offset gui.y-offset\n"
      "HALCMD = sets :y-offset 20\n"
      "HALCMD = net :kins <= motion.analog-out-02 => motion.switchkins-type\n");
  ASSERT_TRUE(machine) << machine.error();
  EXPECT_EQ(machine->switch_output, 2u);
  ASSERT_EQ(machine->types.size(), 3u);
  EXPECT_EQ(machine->types[0].name, "identity");
  EXPECT_FALSE(machine->told_tool_mm);
  // Axis of A at y 20, z -7.5: turned by 90 degrees the origin comes to y 20 + (0 + 7.5).
  EXPECT_NEAR(tilted_y(*machine, 1), 20 + 7.5, 1e-9);
  ASSERT_EQ(machine->notes.size(), 2u);
  EXPECT_EQ(machine->notes[1],
            "xyzac-trt-kins, geometry from HAL: z-rot-point -7.5, y-offset 20; as the module has "
            "them: x-rot-point 0, y-rot-point 0, z-offset 0");
}

TEST_F(KinematicsSetup, ToldPinsGoBeforeHalFiles) {
  hal("a.hal", "setp xyzac-trt-kins.y-offset 20\n");
  KinematicsRequest request;
  request.hal_pins = {{"xyzac-trt-kins.y-offset", 1}, {"other.y-offset", 7}};
  EXPECT_FALSE(request.is_given());
  const auto machine =
      read("[KINS]\nKINEMATICS = xyzac-trt-kins\n[HAL]\nHALFILE = a.hal\n", request, 25.4);
  ASSERT_TRUE(machine) << machine.error();
  EXPECT_NEAR(tilted_y(*machine, 0), 25.4, 1e-9);
}

TEST_F(KinematicsSetup, NumbersThatTheModuleDoesNotTakeAreErrors) {
  KinematicsRequest request;
  request.geometry["pivot-length"] = 5;
  const auto trt = read("[KINS]\nKINEMATICS = rotatekins\n", request);
  ASSERT_FALSE(trt);
  EXPECT_EQ(trt.error(), "'pivot-length' is no number of rotatekins; it takes none");
  request.kinematics = "maxkins";
  EXPECT_TRUE(kinematics_of_request(request, "XYZABC"));
  request.geometry["D4"] = 1;
  const auto max = kinematics_of_request(request, "XYZABC");
  ASSERT_FALSE(max);
  EXPECT_EQ(max.error(), "'D4' is no number of maxkins; it takes pivot-length");
}

TEST_F(KinematicsSetup, TheConfigurationWins) {
  hal("a.hal", "setp xyzac-trt-kins.y-offset 20\n");
  KinematicsRequest request;
  request.geometry["y-offset"] = 5;
  const auto machine =
      read("[KINS]\nKINEMATICS = xyzac-trt-kins\n[HAL]\nHALFILE = a.hal\n", request);
  ASSERT_TRUE(machine) << machine.error();
  EXPECT_NEAR(tilted_y(*machine, 0), 5, 1e-9);
  // And what HAL does not do is said.
  EXPECT_EQ(machine->types.size(), 1u);
  EXPECT_EQ(machine->told_tool_mm, 0.0);
  ASSERT_EQ(machine->notes.size(), 3u);
  EXPECT_EQ(machine->notes[0],
            "no net ties an analog output to motion.switchkins-type in the HAL files: the "
            "kinematics stay xyzac-trt-kins");
  EXPECT_EQ(machine->notes[1],
            "motion.tooloffset.z is not netted to xyzac-trt-kins.tool-offset: the tip of a tool "
            "with a length (G43) moves off its place when the machine turns");
}

TEST_F(KinematicsSetup, InchesAreScaledAndAnglesAreNot) {
  hal("a.hal", "setp genserkins.D-0 2\nsetp genserkins.ALPHA-1 1.5\n");
  const auto machine = read("[KINS]\nKINEMATICS = genserkins\n[HAL]\nHALFILE = a.hal\n", {}, 25.4);
  ASSERT_TRUE(machine) << machine.error();
  EXPECT_NE(
      machine->notes.back().find("from HAL: D-0 50.8, ALPHA-1 1.5; as the module has them: A-0 0,"),
      std::string::npos)
      << machine->notes.back();
}

TEST_F(KinematicsSetup, ASumTellsTheToolsLength) {
  hal("a.hal",
      "loadrt sum2 names=pivotsum\n"
      "net :gui gui.pivot_len pivotsum.in0\n"
      "net :tool <= motion.tooloffset.z => pivotsum.in1\n"
      "net :pivot pivotsum.out => 5axiskins.pivot-length\n"
      "net :k motion.analog-out-03 motion.switchkins-type\n");
  const auto machine =
      read("[KINS]\nKINEMATICS = 5axiskins coordinates=xyzbcwy\n[HAL]\nHALFILE = a.hal\n");
  ASSERT_TRUE(machine) << machine.error();
  EXPECT_FALSE(machine->told_tool_mm);
  EXPECT_EQ(machine->joint_letters, "XYZBCWY");
  EXPECT_NE(machine->notes.back().find("as the module has them: pivot-length 250; set by a running "
                                       "program, not known: pivot-length (from gui.pivot_len)"),
            std::string::npos)
      << machine->notes.back();
}

TEST_F(KinematicsSetup, TrivialKinematicsDoNotSayWhatTurns) {
  const auto machine = read("[KINS]\nKINEMATICS = trivkins coordinates=xyza\n");
  ASSERT_TRUE(machine) << machine.error();
  ASSERT_EQ(machine->notes.size(), 1u);
  EXPECT_EQ(machine->notes[0],
            "trivkins does not say what A, B and C turn: taken for a table that turns about lines "
            "through X0 Y0 Z0 (machine coordinates)");
  KinematicsRequest request;
  request.rotary_side = RotarySide::kHead;
  EXPECT_TRUE(read("[KINS]\nKINEMATICS = trivkins coordinates=xyza\n", request)->notes.empty());
  EXPECT_TRUE(read("[KINS]\nKINEMATICS = trivkins coordinates=xyz\n")->notes.empty());
}

TEST_F(KinematicsSetup, WhatIsNoChainIsRefusedByName) {
  const auto machine = read("[KINS]\nKINEMATICS = tripodkins\n");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().rfind("tripodkins is no chain of links that kerf knows; there are "
                                  "trivkins, ",
                                  0),
            0u)
      << machine.error();
}

TEST_F(KinematicsSetup, LinuxCncsOwnConfigurationsAreUnderstood) {
  const fs::path samples = "/usr/share/doc/linuxcnc/examples/sample-configs/sim/axis/vismach";
  if (!fs::exists(samples)) GTEST_SKIP() << "package linuxcnc-uspace is not installed";
  const fs::path trt = samples / "5axis/table-rotary-tilting";
  Diagnostics said;
  auto ini = IniFile::read((trt / "xyzac-trt.ini").string(), said);
  ASSERT_TRUE(ini);
  const auto machine = kinematics_of_ini(*ini, trt.string(), "XYZAC", 1, {});
  ASSERT_TRUE(machine) << machine.error();
  EXPECT_EQ(machine->switch_output, 3u);
  EXPECT_FALSE(machine->told_tool_mm);
  EXPECT_NE(machine->notes.back().find("z-offset 10, y-offset 20"), std::string::npos)
      << machine->notes.back();
}

}  // namespace
}  // namespace kerf
