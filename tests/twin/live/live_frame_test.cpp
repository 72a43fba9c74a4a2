#include "twin/live/live_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "twin/machine/kinematics/tool_path.h"

namespace kerf {
namespace {

AxisSample at(double x, double y, double z) {
  AxisSample sample;
  sample.set(0, x);
  sample.set(1, y);
  sample.set(2, z);
  return sample;
}

TEST(LiveFrame, MachineCoordinatesBecomeThoseOfTheTip) {
  LiveFrameOptions options;
  options.work.g5x_mm = {12.5, -7.25, -60};
  options.work.g92_mm = {1, 2, 3};
  options.work.rotation_deg = 30;
  const LiveFrame frame(options);
  AxisSample sample = at(100, 50, 20);
  sample.tool_offset_z_mm = 40;
  const SamplePose pose = frame.pose_of(sample, std::nullopt).value();
  // The other way round, as LinuxCNC goes: R * (w + g92) + g5x + length.
  const double c = std::cos(kPi / 6), s = std::sin(kPi / 6);
  const Vec3 w = pose.tip_mm + options.work.g92_mm;
  EXPECT_NEAR(c * w.x - s * w.y + 12.5, 100, 1e-9);
  EXPECT_NEAR(s * w.x + c * w.y - 7.25, 50, 1e-9);
  EXPECT_NEAR(w.z - 60 + 40, 20, 1e-9);
  const std::array<double, 9> back = frame.machine_place_of(pose);
  EXPECT_NEAR(back[0], 100, 1e-9);
  EXPECT_NEAR(back[1], 50, 1e-9);
  EXPECT_NEAR(back[2], 20, 1e-9);
}

/// A lathe has X and Z alone: Y is where the program has 0.
TEST(LiveFrame, OnALatheYStandsWhereNoneComes) {
  AxisSample sample;
  sample.set(0, 30);
  sample.set(2, -12);
  LiveFrameOptions options;
  options.work.g5x_mm = {1, 2, 3};
  options.work.g92_mm = {0.5, 0.25, 0.125};
  EXPECT_FALSE(LiveFrame(options).pose_of(sample, std::nullopt)) << "a mill: it is missing";
  EXPECT_EQ(LiveFrame(options).missing_axes(sample), "Y");
  options.y_stands = true;
  const LiveFrame lathe(options);
  EXPECT_EQ(lathe.missing_axes(sample), "");
  ASSERT_TRUE(lathe.pose_of(sample, std::nullopt));
  EXPECT_EQ(lathe.pose_of(sample, std::nullopt)->tip_mm, Vec3(28.5, 0, -15.125));
  // One that comes counts, as that of a lathe with an axis Y.
  sample.set(1, 7.25);
  EXPECT_EQ(lathe.pose_of(sample, std::nullopt)->tip_mm, Vec3(28.5, 5, -15.125));
  // And what is really missing is named.
  AxisSample no_z;
  no_z.set(0, 30);
  EXPECT_EQ(lathe.missing_axes(no_z), "Z");
  EXPECT_FALSE(lathe.pose_of(no_z, std::nullopt));
}

TEST(LiveFrame, OfPositionsOfTheTipYIsZeroOnALathe) {
  AxisSample sample;
  sample.set(0, 30);
  sample.set(2, -12);
  LiveFrameOptions options;
  options.workpiece_frame = options.y_stands = true;
  options.work.g5x_mm = {1, 2, 3};
  EXPECT_EQ(LiveFrame(options).pose_of(sample, std::nullopt)->tip_mm, Vec3(30, 0, -12));
}

TEST(LiveFrame, JointsAreTheAxesTheyMove) {
  LiveFrameOptions options;
  options.axis = {2, 0, 1, 1, -1, -1, -1, -1, -1};  // ZXYY
  const LiveFrame frame(options);
  AxisSample sample = at(3, 1, 2);
  sample.set(3, 2.5);  // the second joint of the gantry
  EXPECT_EQ(frame.pose_of(sample, std::nullopt)->tip_mm, Vec3(1, 2.5, 3));
}

TEST(LiveFrame, JointsOfBeltsAreSumAndDifference) {
  LiveFrameOptions options;
  options.kinematics =
      std::make_shared<const MachineKinematics>(known_machine("corexykins", "XYZ", {}, {}).value());
  const LiveFrame frame(options);
  AxisSample sample = at(30 + 8, 30 - 8, 5);
  ASSERT_TRUE(frame.pose_of(sample, std::nullopt));
  EXPECT_EQ(frame.pose_of(sample, std::nullopt)->tip_mm, Vec3(30, 8, 5));
  AxisSample one;
  one.set(0, 38);
  one.set(2, 5);
  EXPECT_EQ(frame.missing_axes(one), "X and Y") << "neither by one belt";
}

/// Machines that follow the tip: what LinuxCNC commands for a place comes back as that place.
TEST(LiveFrame, JointsOfAMachineThatFollowsTheTipAreItsPlaceOnThePart) {
  WorkpieceFrame work;
  work.g5x_mm = {12, -7, 30};
  work.g92_mm = {1, 2, 3};
  work.rotation_deg = 25;
  work.offset_abc_deg = {3, 0, -8};
  const auto machine = std::make_shared<const MachineKinematics>(
      known_machine("xyzac-trt-kins", "",
                    {{"x-rot-point", 10}, {"z-rot-point", 20}, {"y-offset", 4}, {"z-offset", 12}},
                    {})
          .value());
  const auto path = ToolPath::create(*machine, work, {});
  LiveFrameOptions options;
  options.kinematics = machine;
  options.work = work;
  const LiveFrame frame(options);
  for (const double length_mm : {0.0, 80.0}) {
    Motion there;
    there.start_known = false;
    there.to_mm = {3, 14, -5};
    there.from_abc_deg = there.to_abc_deg = {-35, 0, 110};
    there.tool_offset_mm = {0, 0, length_mm};
    for (int type = 0; type < 2; ++type) {
      there.torch.analog[machine->switch_output] = static_cast<float>(type);
      const AxisValues joints = path->machine_at(there, 1)->joints;
      AxisSample sample;
      for (std::size_t i = 0; i < 5; ++i) sample.set(i, joints[i]);
      sample.tool_offset_z_mm = length_mm;
      const auto pose = frame.pose_of(sample, std::nullopt, type);
      ASSERT_TRUE(pose);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(pose->tip_mm[i], there.to_mm[i], 1e-9) << type;
      EXPECT_NEAR(pose->abc_deg[0], -35, 1e-9);
      EXPECT_NEAR(pose->abc_deg[2], 110, 1e-9);
      EXPECT_TRUE(pose->abc_known[0] && pose->abc_known[2] && !pose->abc_known[1]);
      // Read without its length, and shortened afterwards: the same.
      sample.tool_offset_z_mm = std::numeric_limits<double>::quiet_NaN();
      const auto bare = frame.pose_of(sample, 0.0, type);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(bare->tip_mm[i] - length_mm * bare->along_tool[i], there.to_mm[i], 1e-9);
      }
    }
  }
  AxisSample half;
  for (const std::size_t i : {0U, 1U, 2U, 3U}) half.set(i, 0);
  EXPECT_FALSE(frame.pose_of(half, std::nullopt));
  EXPECT_EQ(frame.missing_axes(half), "C");
}

TEST(LiveFrame, ARobotNeedsEveryJoint) {
  LiveFrameOptions options;
  options.kinematics =
      std::make_shared<const MachineKinematics>(known_machine("pumakins", "", {}, {}).value());
  const LiveFrame frame(options);
  AxisSample sample;
  for (std::size_t i = 0; i < 6; ++i) {
    if (i != 2 && i != 4) sample.set(i, 10.0 * static_cast<double>(i));
  }
  EXPECT_FALSE(frame.pose_of(sample, std::nullopt));
  EXPECT_EQ(frame.missing_axes(sample), "joint 2 and joint 4");
  sample.set(2, -30);
  sample.set(4, 15);
  const auto pose = frame.pose_of(sample, std::nullopt);
  ASSERT_TRUE(pose);
  const AxisValues axes = options.kinematics->axes_of({0, 10, -30, 30, 15, 50}, 0);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(pose->tip_mm[i], axes[static_cast<std::size_t>(i)]);
}

TEST(LiveFrame, MissingAxesAreNamed) {
  const LiveFrame frame({});
  AxisSample sample;
  sample.set(1, 5);
  EXPECT_FALSE(frame.pose_of(sample, std::nullopt));
  EXPECT_EQ(frame.missing_axes(sample), "X and Z");
}

TEST(LiveFrame, TheToolLengthComesFromTheBestSourceThereIs) {
  LiveFrameOptions options;
  options.table_length_mm = {{1, 10}, {2, 20}};
  AxisSample sample = at(0, 0, 100);
  const auto tip_z = [&](std::optional<double> program) {
    return LiveFrame(options).pose_of(sample, program)->tip_mm.z;
  };
  EXPECT_FALSE(LiveFrame(options).pose_of(sample, std::nullopt)->length_known);
  EXPECT_EQ(tip_z(std::nullopt), 100);
  sample.tool = 2;
  EXPECT_EQ(tip_z(std::nullopt), 80);
  EXPECT_EQ(tip_z(30.0), 70);
  sample.tool_offset_z_mm = 40;
  EXPECT_EQ(tip_z(30.0), 60);
  options.tool_length = ToolLengthFrom::kTable;
  EXPECT_EQ(tip_z(30.0), 80);
  options.tool_length = ToolLengthFrom::kProgram;
  EXPECT_EQ(tip_z(30.0), 70);
  options.tool_length = ToolLengthFrom::kNone;
  EXPECT_EQ(tip_z(30.0), 100);
  options.tool_length = ToolLengthFrom::kTable;
  sample.tool = -1;
  options.tool = 1;
  EXPECT_EQ(tip_z(30.0), 90);
  sample.tool = 0;
  EXPECT_EQ(tip_z(30.0), 100);
  EXPECT_TRUE(LiveFrame(options).pose_of(sample, std::nullopt)->length_known);
}

TEST(LiveFrame, WorkpieceCoordinatesAreTakenAsTheyAre) {
  LiveFrameOptions options;
  options.workpiece_frame = true;
  options.work.g5x_mm = {1, 2, 3};
  options.table_length_mm = {{1, 10}};
  AxisSample sample = at(4, 5, 6);
  sample.tool = 1;
  EXPECT_EQ(LiveFrame(options).pose_of(sample, std::nullopt)->tip_mm, Vec3(4, 5, 6));
}

}  // namespace
}  // namespace kerf
