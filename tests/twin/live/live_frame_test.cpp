#include "twin/live/live_frame.h"

#include <gtest/gtest.h>

#include <cmath>

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
  const LivePose pose = frame.pose_of(sample, std::nullopt).value();
  // The other way round, as LinuxCNC goes: R * (w + g92) + g5x + length.
  const double c = std::cos(kPi / 6), s = std::sin(kPi / 6);
  const Vec3 w = pose.tip_mm + options.work.g92_mm;
  EXPECT_NEAR(c * w.x - s * w.y + 12.5, 100, 1e-9);
  EXPECT_NEAR(s * w.x + c * w.y - 7.25, 50, 1e-9);
  EXPECT_NEAR(w.z - 60 + 40, 20, 1e-9);
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
