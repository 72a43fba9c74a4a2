// What is said of programs that tilt and turn where they cannot.
#include "twin/machine/kinematics/rotary_checks.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

class RotaryChecks : public ::testing::Test {
 protected:
  static ToolPath path_of(const std::string& kinematics, const KinematicsGeometry& geometry = {},
                          std::optional<double> told_mm = {}) {
    auto machine = known_machine(kinematics, "XYZ", geometry, {});
    EXPECT_TRUE(machine) << machine.error();
    machine->told_tool_mm = told_mm;
    auto path = ToolPath::create(std::move(machine.value()), {}, {});
    EXPECT_TRUE(path) << path.error();
    return std::move(path.value());
  }
  static Motion feed(const Vec3& from, const Vec3& to, const std::array<double, 3>& from_abc,
                     const std::array<double, 3>& to_abc, std::uint32_t line = 12) {
    Motion m;
    m.kind = MotionKind::kFeed;
    m.from_mm = from;
    m.to_mm = to;
    m.from_abc_deg = from_abc;
    m.to_abc_deg = to_abc;
    m.source.line = line;
    return m;
  }
  std::vector<RotaryFault> check(const ToolPath& path, const Motion& m, double duration_s = 0) {
    RotaryCheck one(path, joints_);
    std::vector<RotaryFault> out;
    one.check(m, duration_s, out);
    one.check(m, duration_s, out);  // told once
    if (!out.empty()) {
      EXPECT_GE(one.count(out[0].kind), 2u);
    }
    return out;
  }

  std::array<AxisLimits, kAxisCount> joints_{};
};

TEST_F(RotaryChecks, WordsOfAnAxisThatIsNotThere) {
  const auto faults = check(path_of("trivkins"), feed({0, 0, 0}, {1, 0, 0}, {}, {0, 90, 0}));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].kind, RotaryFaultKind::kNoAxis);
  EXPECT_EQ(faults[0].source.line, 12u);
  EXPECT_EQ(faults[0].text,
            "B90 has nothing to turn: the axes of the machine are X Y Z; it is cut as if B stood "
            "still");
  EXPECT_TRUE(
      check(path_of("trivkins coordinates=xyzb"), feed({0, 0, 0}, {1, 0, 0}, {}, {0, 90, 0}))
          .empty());
}

TEST_F(RotaryChecks, ThroughThePole) {
  const ToolPath path = path_of("xyzac-trt-kins");
  // A goes through a tilt of half a degree while C swings round.
  const auto faults = check(path, feed({0, 0, 0}, {0.1, 0, 0}, {0.5, 0, 0}, {0.5, 0, 178}));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].kind, RotaryFaultKind::kSingularPose);
  EXPECT_EQ(faults[0].axis, 'C');
  EXPECT_EQ(faults[0].text,
            "singular pose: C turns by 178.0 degrees while the spindle turns by 1.55 in the part: "
            "it passes the pole, where C cannot tilt the tool");
  // The same turn far from the pole is a cut like any other.
  EXPECT_TRUE(check(path, feed({0, 0, 0}, {0.1, 0, 0}, {40, 0, 0}, {40, 0, 178})).empty());
}

TEST_F(RotaryChecks, JointsThatFollowTheTip) {
  for (std::size_t axis : {0u, 1u, 2u}) {
    joints_[axis] = {.present = true, .min = -200, .max = 200, .max_velocity = 50};
  }
  const ToolPath path = path_of("xyzac-trt-kins");
  // The tip 150 mm beside C: a quarter turn in a second takes the slides along 236 mm.
  const Motion turn = feed({150, 0, 0}, {150, 0, 0}, {}, {0, 0, 90});
  EXPECT_TRUE(check(path, turn, 10).empty());
  const auto fast = check(path, turn, 1);
  ASSERT_EQ(fast.size(), 2u);
  EXPECT_EQ(fast[0].kind, RotaryFaultKind::kJointTooFast);
  EXPECT_EQ(fast[0].axis, 'Y');
  EXPECT_NEAR(std::stod(fast[0].text.substr(fast[0].text.find(" at ") + 4)), 150 * kPi / 2, 1);
}

TEST_F(RotaryChecks, AToolTooLongForTheTravel) {
  joints_[2] = {.present = true, .min = -500, .max = 300};
  const ToolPath path = path_of("5axiskins", {{"pivot-length", 250}});
  Motion m = feed({0, 0, 0}, {10, 0, 0}, {0, 90, 0}, {0, 90, 0});
  m.tool_offset_mm = {0, 0, 60};
  EXPECT_TRUE(check(path, m).empty());
  m.tool_offset_mm = {0, 0, -60};
  m.from_mm.z = m.to_mm.z = 620;
  const auto faults = check(path, m);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].kind, RotaryFaultKind::kJointLimit);
  EXPECT_EQ(faults[0].text.rfind("the joint of Z is sent to 370.000 mm, 70.000 mm beyond its limit "
                                 "of 300.000 mm, to hold a tool of -60.0 mm there",
                                 0),
            0u)
      << faults[0].text;
}

TEST_F(RotaryChecks, AToolLongerThanThePivot) {
  const ToolPath path = path_of("5axiskins", {{"pivot-length", 100}}, 0.0);
  Motion m = feed({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 10, 0});
  m.tool = 4;
  m.tool_offset_mm = {0, 0, 90};
  EXPECT_TRUE(check(path, m).empty());
  m.tool_offset_mm = {0, 0, 120};
  const auto faults = check(path, m);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].text,
            "tool 4 is 120.0 mm long, longer than the way to the pivot that 5axiskins reckons with "
            "(100.0 mm)");
}

TEST_F(RotaryChecks, JointsAreReadFromTheIni) {
  Diagnostics said;
  IniFile ini = IniFile::parse(
      "[JOINT_0]\nMIN_LIMIT = -1\nMAX_LIMIT = 2\nMAX_VELOCITY = 3\n[JOINT_1]\nMIN_LIMIT = -90\n"
      "MAX_VELOCITY = 40\n",
      "m.ini", {}, said);
  const auto limits = joint_limits_of_ini(ini, "XA", 25.4);
  EXPECT_EQ(limits[0].max, 2 * 25.4);
  EXPECT_EQ(limits[0].max_velocity, 3 * 25.4);
  EXPECT_EQ(limits[3].min, -90);
  EXPECT_TRUE(std::isinf(limits[3].max));
  EXPECT_FALSE(limits[1].present);
}

}  // namespace
}  // namespace kerf
