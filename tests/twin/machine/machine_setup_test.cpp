#include "twin/machine/machine_setup.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "twin/machine/kinematics/machine_kinematics.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

class MachineSetupTest : public testing::Test {
 protected:
  MachineSetupTest() {
    std::string name = (fs::temp_directory_path() / "kerf-ini-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~MachineSetupTest() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ + "/" + name) << text;
    return folder_ + "/" + name;
  }
  bool read(const std::string& text) {
    diagnostics_.clear();
    setup_ = {};
    return read_machine_setup(write("mill.ini", text), setup_, diagnostics_);
  }
  std::string messages() const {
    std::string out;
    for (const Diagnostic& d : diagnostics_) out += to_string(d);
    return out;
  }
  const AxisLimits& axis(char letter) const {
    return setup_.timeline.limits.axes[std::string("XYZABCUVW").find(letter)];
  }

  std::string folder_;
  MachineSetup setup_;
  Diagnostics diagnostics_;
};

const char* const kMill =
    "[TRAJ]\nCOORDINATES = X Y Z A\nLINEAR_UNITS = mm\nMAX_LINEAR_VELOCITY = 90\n"
    "[KINS]\nKINEMATICS = trivkins\nJOINTS = 4\n"
    "[EMCMOT]\nSERVO_PERIOD = 2000000\n[EMCIO]\nTOOL_TABLE = tool.tbl\nCYCLE_TIME = 0.05\n"
    "[RS274NGC]\nPARAMETER_FILE = mill.var\nRS274NGC_STARTUP_CODE = G21 G64 P0.01\n"
    "[AXIS_X]\nMAX_VELOCITY = 80\nMAX_ACCELERATION = 400\nMIN_LIMIT = -1\nMAX_LIMIT = 401.5\n"
    "[JOINT_1]\nMAX_VELOCITY = 70\nMAX_ACCELERATION = 300\nMIN_LIMIT = 0\nMAX_LIMIT = 300\n"
    "[AXIS_Z]\nMAX_VELOCITY = 50\nMAX_ACCELERATION = 200\n[JOINT_2]\nHOME = 90\n"
    "[AXIS_A]\nMAX_VELOCITY = 36\nMAX_ACCELERATION = 72\nMIN_LIMIT = -360\nMAX_LIMIT = 360\n"
    "[SPINDLE_0]\nMAX_FORWARD_VELOCITY = 4500\n";

TEST_F(MachineSetupTest, AMetricMill) {
  write("tool.tbl", "T1 P1 D6\n");
  write("mill.var", "5161\t0\n");
  ASSERT_TRUE(read(kMill)) << messages();
  EXPECT_EQ(messages(), "");
  EXPECT_FALSE(setup_.interpreter.inch_machine);
  EXPECT_EQ(setup_.interpreter.axis_mask, 15);
  EXPECT_EQ(setup_.interpreter.start[2], 90);
  EXPECT_TRUE(setup_.interpreter.tool_lengths);
  EXPECT_EQ(setup_.interpreter.startup_code, "G21 G64 P0.01");
  EXPECT_EQ(setup_.interpreter.ini_path, folder_ + "/mill.ini");
  EXPECT_EQ(setup_.interpreter.working_folder, folder_);
  EXPECT_EQ(setup_.interpreter.parameter_path, folder_ + "/mill.var");
  EXPECT_EQ(setup_.tool_table_path, folder_ + "/tool.tbl");
  EXPECT_EQ(setup_.spindle_max_rpm, 4500);
  EXPECT_EQ(axis('X').max, 401.5);
  EXPECT_EQ(axis('X').max_velocity, 80);
  EXPECT_EQ(axis('Y').max_acceleration, 300) << "of its joint";
  EXPECT_EQ(axis('Y').max, 300);
  EXPECT_TRUE(std::isinf(axis('Z').max)) << "no limit given";
  EXPECT_EQ(axis('A').min, -360);
  EXPECT_FALSE(axis('B').present);
  const MachineLimits& limits = setup_.timeline.limits;
  EXPECT_EQ(limits.max_linear_velocity_mm_per_s, 90);
  EXPECT_DOUBLE_EQ(limits.servo_period_s, 0.002);
  EXPECT_EQ(limits.io_period_s, 0.05);
  EXPECT_TRUE(setup_.timeline.limits_known);
}

TEST_F(MachineSetupTest, AnInchMillInMmInside) {
  write("mill.var", "5161\t0\n");
  ASSERT_TRUE(
      read("[TRAJ]\nCOORDINATES = XYZA\nLINEAR_UNITS = inch\nMAX_VELOCITY = 2\n"
           "[RS274NGC]\nPARAMETER_FILE = mill.var\n"
           "[AXIS_X]\nMAX_VELOCITY = 1\nMAX_ACCELERATION = 10\nMAX_LIMIT = 20\n"
           "[AXIS_A]\nMAX_VELOCITY = 36\nMAX_LIMIT = 90\n[JOINT_2]\nHOME = 4\n"))
      << messages();
  EXPECT_TRUE(setup_.interpreter.inch_machine);
  EXPECT_DOUBLE_EQ(axis('X').max, 508);
  EXPECT_DOUBLE_EQ(axis('X').max_velocity, 25.4);
  EXPECT_DOUBLE_EQ(axis('X').max_acceleration, 254);
  EXPECT_EQ(axis('A').max, 90) << "degrees stay";
  EXPECT_DOUBLE_EQ(setup_.interpreter.start[2], 101.6);
  EXPECT_DOUBLE_EQ(setup_.timeline.limits.max_linear_velocity_mm_per_s, 50.8);
}

TEST_F(MachineSetupTest, WithoutAParameterFileLimitsAreNotChecked) {
  write("tool.tbl", "T1 P1 D6\n");
  ASSERT_TRUE(read(kMill));
  EXPECT_EQ(messages(),
            folder_ + "/mill.ini:14:18: warning: [RS274NGC]PARAMETER_FILE: cannot read " + folder_ +
                "/mill.var: No such file or directory\n"
                "    14 | PARAMETER_FILE = mill.var\n"
                "       |                  ^\n"
                "   hint: work offsets count as 0, and limits are not checked\n");
  EXPECT_TRUE(std::isinf(axis('X').max));
  EXPECT_EQ(axis('X').max_velocity, 80);
}

TEST_F(MachineSetupTest, FaultsNameTheirPlacesAllAtOnce) {
  write("mill.var", "5161\t0\n");
  EXPECT_FALSE(
      read("[TRAJ]\nLINEAR_UNITS = furlong\n[EMCIO]\nTOOL_TABLE = nix.tbl\n[RS274NGC]\n"
           "PARAMETER_FILE = mill.var\n[AXIS_X]\nMAX_VELOCITY = 0\nMAX_LIMIT = far\n"));
  std::string out;
  for (const Diagnostic& d : diagnostics_) {
    out += std::to_string(d.line) + ":" + std::to_string(d.column) + ": " + d.message + "\n";
  }
  EXPECT_EQ(out,
            "2:16: [TRAJ]LINEAR_UNITS: 'furlong' is not a number\n"
            "9:13: [AXIS_X]MAX_LIMIT: 'far' is not a number\n"
            "8:16: [AXIS_X]MAX_VELOCITY: 0 is not allowed; must be above 0\n"
            "4:14: [EMCIO]TOOL_TABLE: cannot read " +
                folder_ + "/nix.tbl: No such file or directory\n");
  MachineSetup setup;
  Diagnostics missing;
  EXPECT_FALSE(read_machine_setup(folder_ + "/nix.ini", setup, missing));
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_EQ(missing[0].message, "cannot read " + folder_ + "/nix.ini: No such file or directory");
}

TEST_F(MachineSetupTest, IncludesAreFollowedAndHandedToTheInterpreter) {
  write("mill.var", "5161\t0\n");
  write("axes.inc", "[AXIS_X]\nMAX_VELOCITY = 33\n[RS274NGC]\nPARAMETER_FILE = mill.var\n");
  ASSERT_TRUE(read("[TRAJ]\nLINEAR_UNITS = mm\n#INCLUDE axes.inc\n")) << messages();
  EXPECT_EQ(axis('X').max_velocity, 33);
  EXPECT_NE(setup_.interpreter.ini_text.find("MAX_VELOCITY = 33"), std::string::npos);
  ASSERT_TRUE(read("[RS274NGC]\nPARAMETER_FILE = mill.var\n"));
  EXPECT_EQ(setup_.interpreter.ini_text, "");
}

TEST_F(MachineSetupTest, WhatIsNotUnderstoodIsListed) {
  write("mill.var", "5161\t0\n");
  ASSERT_TRUE(
      read("[TRAJ]\nMAX_LINEAR_VELOCTY = 5\nSPINDLES = 1\n[RS274NGC]\nPARAMETER_FILE = mill.var\n"
           "REMAP = M400\n[EMCIO]\nDB_PROGRAM = ./tools\n[HAL]\nANYTHING = 1\n"));
  std::string out;
  for (const Diagnostic& d : diagnostics_) {
    EXPECT_EQ(d.severity, Severity::kNote);
    out += std::to_string(d.line) + ": " + d.message + "\n";
  }
  EXPECT_EQ(out,
            "2: [TRAJ]MAX_LINEAR_VELOCTY is not understood; it is passed over\n"
            "8: [EMCIO]DB_PROGRAM is not modelled\n");
}

TEST_F(MachineSetupTest, ToolChangePosition) {
  write("mill.var", "5161\t0\n");
  const std::string parameters = "[RS274NGC]\nPARAMETER_FILE = mill.var\n";
  ASSERT_TRUE(read(parameters + "[EMCIO]\nTOOL_CHANGE_POSITION = 1 2.5 -3\n"));
  EXPECT_EQ(setup_.interpreter.tool_change_position, (std::vector<double>{1, 2.5, -3}));
  EXPECT_EQ(messages(), "");
  ASSERT_TRUE(read("[TRAJ]\nLINEAR_UNITS = inch\n" + parameters +
                   "[EMCIO]\nTOOL_CHANGE_POSITION = 1 0 0 90 0 0 0 0 2\n"));
  EXPECT_EQ(setup_.interpreter.tool_change_position,
            (std::vector<double>{25.4, 0, 0, 90, 0, 0, 0, 0, 50.8}));
  for (const char* const wrong : {"1 2", "1, 2, 3", "1 2 3 4", "up"}) {
    ASSERT_TRUE(read(parameters + "[EMCIO]\nTOOL_CHANGE_POSITION = " + wrong + "\n"));
    EXPECT_TRUE(setup_.interpreter.tool_change_position.empty()) << wrong;
    EXPECT_NE(messages().find("is not three, six or nine numbers"), std::string::npos)
        << messages();
  }
}

TEST_F(MachineSetupTest, JointsOfAGantryAndUnknownKinematics) {
  write("mill.var", "5161\t0\n");
  ASSERT_TRUE(
      read("[KINS]\nKINEMATICS = trivkins coordinates=xyyz kinstype=BOTH\n[RS274NGC]\n"
           "PARAMETER_FILE = mill.var\n[JOINT_3]\nMAX_VELOCITY = 7\nHOME = 5\n"))
      << messages();
  EXPECT_EQ(setup_.kinematics, "trivkins");
  EXPECT_EQ(axis('Z').max_velocity, 7);
  EXPECT_EQ(setup_.interpreter.start[2], 5);
  ASSERT_TRUE(read("[KINS]\nKINEMATICS = xyzac-trt-kins\n"));
  ASSERT_TRUE(setup_.timeline.kinematics);
  EXPECT_EQ(setup_.timeline.kinematics->module, "xyzac-trt-kins");
  ASSERT_TRUE(read("[KINS]\nKINEMATICS = tripodkins\n"));
  EXPECT_FALSE(setup_.timeline.kinematics);
  EXPECT_NE(
      messages().find("mill.ini:2:14: warning: tripodkins is no chain of links that kerf knows"),
      std::string::npos)
      << messages();
}

/// Every sample that LinuxCNC installs loads, or says where and why not.
TEST_F(MachineSetupTest, SamplesOfLinuxcnc) {
  const fs::path samples = "/usr/share/doc/linuxcnc/examples/sample-configs";
  if (!fs::is_directory(samples)) GTEST_SKIP() << "no sample configurations of LinuxCNC";
  std::size_t good = 0;
  std::size_t bad = 0;
  for (const auto& entry : fs::recursive_directory_iterator(samples)) {
    if (entry.path().extension() != ".ini" || !entry.is_regular_file()) continue;
    MachineSetup setup;
    Diagnostics diagnostics;
    if (read_machine_setup(entry.path().string(), setup, diagnostics)) {
      ++good;
      EXPECT_GT(setup.interpreter.axis_mask, 0) << entry.path();
      continue;
    }
    ++bad;
    for (const Diagnostic& d : diagnostics) {
      if (d.severity != Severity::kError) continue;
      // Pieces that others include have nothing of a machine.
      const bool is_piece = d.message.find("is no INI of a LinuxCNC machine") != std::string::npos;
      EXPECT_TRUE(d.line != 0 || is_piece) << entry.path();
      std::cout << to_string(d);
    }
  }
  EXPECT_GE(good, 280U);
  std::cout << good << " samples load, " << bad << " say why not\n";
}

/// A robot whose joints are homed to 0, -45, 0, 0, -45 and 0 degrees is where LinuxCNC 2.9 says it
/// is: at the place that its kinematics make of them, not at their values.
TEST_F(MachineSetupTest, AHomedRobotStandsWhereItsKinematicsSay) {
  std::string ini =
      "[TRAJ]\nCOORDINATES = X Y Z A B C\nLINEAR_UNITS = mm\n"
      "[KINS]\nKINEMATICS = pumakins\nJOINTS = 6\n[RS274NGC]\nPARAMETER_FILE = p.var\n";
  write("p.var", "5220 1\n");
  const std::array<double, 6> home{0, -45, 0, 0, -45, 0};
  for (std::size_t i = 0; i < home.size(); ++i) {
    ini += "[JOINT_" + std::to_string(i) + "]\nTYPE = ANGULAR\nHOME = " + std::to_string(home[i]) +
           "\n";
  }
  read(ini);
  ASSERT_TRUE(setup_.timeline.kinematics) << messages();
  const auto& start = setup_.interpreter.start;
  EXPECT_NEAR(start[0], 600.33008, 1e-4);
  EXPECT_NEAR(start[1], 70, 1e-4);
  EXPECT_NEAR(start[2], -35.35534, 1e-4);
  EXPECT_NEAR(start[4], -90, 1e-4);
}

/// Joints of a robot are called X Y Z and turn: on an inch machine they stay degrees.
TEST_F(MachineSetupTest, JointsThatTurnCountDegreesWhateverTheirLetters) {
  write("p.var", "5220 1\n");
  const std::string head =
      "[RS274NGC]\nPARAMETER_FILE = p.var\n[TRAJ]\nLINEAR_UNITS = inch\nCOORDINATES = ";
  std::string ini = head + "XYZABC\n[KINS]\nKINEMATICS = pumakins\nJOINTS = 6\n";
  for (int i = 0; i < 6; ++i) ini += "[JOINT_" + std::to_string(i) + "]\nTYPE = ANGULAR\n";
  ini += "MAX_LIMIT = 100\n[JOINT_0]\nMAX_LIMIT = 160\n[AXIS_Y]\nMAX_LIMIT = 10\n";
  read(ini);
  EXPECT_EQ(setup_.turning_joints, 0b111111) << messages();
  EXPECT_TRUE(std::isinf(axis('X').max)) << "160 degrees of its joint are no inches of X";
  EXPECT_EQ(axis('Y').max, 254);
  EXPECT_EQ(axis('C').max, 100);
  // Without TYPE the kinematics know, and without those the letters.
  read(head + "XYZABC\n[KINS]\nKINEMATICS = scarakins\nJOINTS = 6\n");
  EXPECT_EQ(setup_.turning_joints & 0b1111, 0b1011) << "its third joint slides";
  read(head + "XYYZA\n[KINS]\nKINEMATICS = trivkins coordinates=xyyza\nJOINTS = 5\n");
  EXPECT_EQ(setup_.turning_joints, 0b10000);
  // maxkins has a joint for every axis, also for those that the INI does not name.
  read(head + "XYZBC\n[KINS]\nKINEMATICS = maxkins\nJOINTS = 6\n[JOINT_5]\nMAX_LIMIT = 7\n");
  EXPECT_EQ(setup_.turning_joints, 0b111000);
  EXPECT_EQ(setup_.timeline.joint_limits[5].max, 7) << "of C";
}

}  // namespace
}  // namespace kerf
