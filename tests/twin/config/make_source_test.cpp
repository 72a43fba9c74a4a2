// From a configuration to a source, and how its samples are to be read.
#include "twin/config/make_source.h"

#include <gtest/gtest.h>

#include "tests/twin/config/config_support.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;

struct Made {
  Diagnostics diagnostics;
  std::optional<LiveConfig> config;
  std::unique_ptr<PositionSource> source;

  explicit Made(const std::string& text) : config(parse_config(text, "", {}, diagnostics)) {
    if (config) source = make_source(*config, diagnostics);
  }
  std::string said() const {
    std::string out;
    for (const Diagnostic& one : diagnostics) out += to_string(one);
    return out;
  }
};

TEST(MakeSource, EachType) {
  const Made modbus("source: {type: modbus, tcp: 'h:7', map: {X: {register: 0}}}\n");
  ASSERT_TRUE(modbus.source) << modbus.said();
  EXPECT_EQ(modbus.source->describe(), "modbus tcp h:7 unit 1");
  const Made can("source: {type: can, interface: can7, map: {X: {id: 1}}}\n");
  ASSERT_TRUE(can.source) << can.said();
  EXPECT_EQ(can.source->describe(), "can can7");
  const Made hal("source: {type: hal}\n");
  ASSERT_TRUE(hal.source) << hal.said();
  EXPECT_EQ(coordinates_of(*hal.config, *hal.source), CoordinateKind::kJoints);
}

TEST(MakeSource, WhatOnlyTheWorldTells) {
  const Made none("machine: {tool: 3}\n");
  EXPECT_FALSE(none.source);
  EXPECT_EQ(none.said(),
            "kerf: error: the configuration has no source\n"
            "   hint: `kerf config schema` lists the keys of `source:`\n");
  const ConfigFolder folder;
  const Made log("source: {type: log, file: " + folder.path("none.csv") + "}\n");
  EXPECT_FALSE(log.source);
  EXPECT_NE(log.said().find(folder.path("none.csv")), std::string::npos) << log.said();
  const Made hal("source: {type: hal, kerf_hal_path: " + folder.path("kerf-hal") + "}\n");
  EXPECT_FALSE(hal.source);
  EXPECT_NE(hal.said().find("source.kerf_hal_path: " + folder.path("kerf-hal")), std::string::npos)
      << hal.said();
}

TEST(MakeSource, HalsamplerInInchesWithARotaryJoint) {
  const ConfigFolder folder;
  const std::string file = folder.write("a.log", "1 2 90\n2 3 91\n");
  const Made made("machine: {joints: XA}\nsource: {type: log, units: inch, file: " + file +
                  ", pins: [joint.0.pos-fb, joint.1.pos-fb]}\n");
  // Without `-t` the first column is a pin as well; three columns are one too many for two pins.
  ASSERT_TRUE(made.source) << made.said();
  AxisSample sample;
  ASSERT_EQ(made.source->next(sample, milliseconds(0)), PositionSource::Next::kSample);
  EXPECT_DOUBLE_EQ(sample.position[0], 2 * 25.4);
  EXPECT_EQ(sample.position[1], 90);
  const LiveFrameOptions frame = frame_for(*made.config, *made.source);
  EXPECT_EQ(frame.axis, (std::array<int, kMaxPositions>{0, 3, -1, -1, -1, -1, -1, -1, -1}));
}

/// The INI or the kinematics know better than the letters: a robot's joints turn.
TEST(MakeSource, JointsOfAnInchRobotStayDegrees) {
  const ConfigFolder folder;
  const std::string file = folder.write("a.log", "10 20 30\n11 21 31\n");
  Diagnostics diagnostics;
  std::optional<LiveConfig> config =
      parse_config("machine: {joints: XYZABC}\nsource: {type: log, units: inch, file: " + file +
                       ", pins: [joint.0.pos-fb, joint.1.pos-fb, joint.2.pos-fb]}\n",
                   "", {}, diagnostics);
  ASSERT_TRUE(config);
  config->machine.turning_joints = 0b011;
  const auto source = make_source(*config, diagnostics);
  ASSERT_TRUE(source);
  AxisSample sample;
  ASSERT_EQ(source->next(sample, milliseconds(0)), PositionSource::Next::kSample);
  EXPECT_EQ(sample.position[0], 10);
  EXPECT_EQ(sample.position[1], 20);
  EXPECT_DOUBLE_EQ(sample.position[2], 30 * 25.4);
}

TEST(MakeSource, ColumnsOfALogDecideWhatPositionsAre) {
  const ConfigFolder folder;
  const std::string file = folder.write("a.csv", "t,x,y,z\n0,1,2,3\n0.1,1,2,3\n");
  const std::string text = "source: {type: log, file: " + file;
  const Made made(text + "}\nmachine: {joints: ZYX}\n");
  ASSERT_TRUE(made.source) << made.said();
  EXPECT_EQ(coordinates_of(*made.config, *made.source), CoordinateKind::kAxes);
  EXPECT_EQ(frame_for(*made.config, *made.source).axis, LiveFrameOptions{}.axis);
  const Made joints(text + ", coordinates: joints}\n");
  EXPECT_FALSE(joints.source);
  EXPECT_NE(joints.said().find("source.coordinates: joints, but the columns of "),
            std::string::npos)
      << joints.said();
}

TEST(MakeSource, FrameOfARecordingUnlessTheUserSaysOtherwise) {
  const ConfigFolder folder;
  const std::string file =
      folder.write("a.csv",
                   "# kerf-recording/1\n# source: test\n# units: mm\n"
                   "# coordinates: axes workpiece\n"
                   "# start: 2026-03-01T09:30:00.000000000Z\n"
                   "t_host,t_device,x,y,z,tool,line,tool_offset_z,spindle_rpm\n"
                   "1772357400.000000000,,1,2,3,1,0,-,0\n");
  const std::string text = "source: {type: log, file: " + file;
  const Made made(text + "}\n");
  ASSERT_TRUE(made.source) << made.said();
  EXPECT_TRUE(frame_for(*made.config, *made.source).workpiece_frame);
  const Made user(text + ", frame: machine}\n");
  ASSERT_TRUE(user.source) << user.said();
  EXPECT_FALSE(frame_for(*user.config, *user.source).workpiece_frame);
}

TEST(MakeSource, FrameOfTheMachine) {
  const Made made(
      "machine: {joints: XYYZ, work_offset: {x: 5, rotation: 30}, tool_length: program, tool: 9}\n"
      "source: {type: modbus, tcp: h, coordinates: joints, map: {J0: {register: 0}}}\n");
  ASSERT_TRUE(made.source) << made.said();
  const LiveFrameOptions frame = frame_for(*made.config, *made.source);
  EXPECT_EQ(frame.axis, (std::array<int, kMaxPositions>{0, 1, 1, 2, -1, -1, -1, -1, -1}));
  EXPECT_FALSE(frame.workpiece_frame);
  EXPECT_EQ(frame.work.g5x_mm.x, 5);
  EXPECT_EQ(frame.work.rotation_deg, 30);
  EXPECT_EQ(frame.tool_length, ToolLengthFrom::kProgram);
  EXPECT_EQ(frame.tool, 9);
}

}  // namespace
}  // namespace kerf
