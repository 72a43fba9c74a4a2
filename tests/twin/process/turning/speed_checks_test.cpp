#include "twin/process/turning/speed_checks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/twin/process/motions.h"

namespace kerf {
namespace {

constexpr double kLeastRadius_mm = SurfaceSpeed::kSmallestRadius_mm;

std::vector<Finding> told_of(const std::vector<Motion>& motions, double max_rpm) {
  FindingLog log;
  SpeedChecks checks(log);
  for (const Motion& m : motions) {
    if (m.kind == MotionKind::kToolChange) checks.end_tool();
    checks.check(m, TimedStep{}, max_rpm);
  }
  return log.kept();
}

/// Facing from X20 to where it says, at 200 m/min.
MotionList facing(double to_mm, double cap_rpm = 1e30) {
  MotionList program;
  program.at({20, 0, 0}).tool(1).spindle(true).feed({to_mm, 0, 0});
  program.last().surface = {200'000, cap_rpm, 0};
  return program;
}

TEST(SpeedChecks, TheGreatestSpeedOnTheWayCounts) {
  // 200 m/min are 200000 / (2 pi r) rpm: 1591.5 at X20, 6366.2 at X5.
  EXPECT_EQ(told_of(facing(5).list(), 6367).size(), 0U);
  const std::vector<Finding> told = told_of(facing(5).list(), 6366);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].severity, Severity::kError);
  EXPECT_EQ(told[0].text, "G96 with 200 m/min asks for up to 6366 rpm, and the spindle does 6366");
}

TEST(SpeedChecks, DIsTheCap) {
  EXPECT_EQ(told_of(facing(0, 3000).list(), 3000).size(), 0U);
  EXPECT_EQ(told_of(facing(0, 3001).list(), 3000).size(), 1U);
  EXPECT_EQ(told_of(facing(0, 3000).list(), 0).size(), 0U);
}

TEST(SpeedChecks, WithoutALimitOnlyWhatHasNoBoundIsTold) {
  EXPECT_EQ(told_of(facing(kLeastRadius_mm * 1.01).list(), 0).size(), 0U);
  const std::vector<Finding> told = told_of(facing(-0.4).list(), 0);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].severity, Severity::kWarning);
}

TEST(SpeedChecks, OnceATool) {
  MotionList program = facing(5);
  program.feed({4, 0, 0});
  program.last().surface = {200'000, 1e30, 0};
  std::vector<Finding> told = told_of(program.list(), 1000);
  ASSERT_EQ(told.size(), 1U);
  // At X4.
  EXPECT_NE(told[0].text.find("7958 rpm"), std::string::npos) << told[0].text;
  program.tool(2).feed({3, 0, 0});
  program.last().surface = {200'000, 1e30, 0};
  EXPECT_EQ(told_of(program.list(), 1000).size(), 2U);
}

TEST(SpeedChecks, SAsItIsSaid) {
  MotionList program;
  program.at({20, 0, 0}).tool(1).spindle(true).feed({20, 0, -10});  // 10000 rpm
  EXPECT_EQ(told_of(program.list(), 10000).size(), 0U);
  const std::vector<Finding> told = told_of(program.list(), 8000);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].text, "S asks for 10000 rpm, and the spindle does 8000");
  MotionList stands;
  stands.at({20, 0, 0}).tool(1).spindle(false).feed({20, 0, -10});
  EXPECT_EQ(told_of(stands.list(), 100).size(), 0U);
}

}  // namespace
}  // namespace kerf
