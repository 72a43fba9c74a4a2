#include "twin/process/axis_limits.h"

#include <gtest/gtest.h>

#include "tests/twin/process/motions.h"

namespace kerf {
namespace {

MachineLimits box_limits() {
  MachineLimits limits = MachineLimits::small_mill();
  limits.axes[0].min = 0;
  limits.axes[0].max = 400;
  limits.axes[1].min = 0;
  limits.axes[1].max = 300;
  limits.axes[2].min = -100;
  limits.axes[2].max = 0;
  limits.axes[3].min = -90;
  limits.axes[3].max = 90;
  return limits;
}

std::vector<std::string> found(const MotionList& program, const WorkpieceFrame& frame) {
  FindingLog log;
  AxisLimitCheck check(box_limits(), log);
  check.set_frame(frame);
  for (const Motion& m : program.list()) check.check(m, {});
  std::vector<std::string> out;
  for (const Finding& f : log.kept()) {
    EXPECT_EQ(f.id, FindingId::kAxisLimit);
    out.push_back(std::to_string(f.source.line) + ": " + f.text);
  }
  return out;
}

using Texts = std::vector<std::string>;

const WorkpieceFrame kMiddle{.g5x_mm = {200, 150, -50}};

TEST(AxisLimits, WithinIsNothingAndAtTheLimitToo) {
  EXPECT_EQ(found(MotionList().traverse({200, 150, 50}).feed({-200, -150, -50}), kMiddle), Texts{});
}

TEST(AxisLimits, OneFindingAnEventWithItsWorst) {
  const MotionList program = MotionList()
                                 .feed({201, 0, 0})
                                 .feed({203, 0, 0})
                                 .feed({202, 0, 0})
                                 .feed({0, 0, 0})
                                 .feed({0, 0, -51.5});
  EXPECT_EQ(
      found(program, kMiddle),
      (Texts{"1: axis X is sent to 403.000 mm, 3.000 mm beyond its limit of 400.000 mm (machine "
             "coordinates)",
             "5: axis Z is sent to -101.500 mm, 1.500 mm beyond its limit of -100.000 mm (machine "
             "coordinates)"}));
}

TEST(AxisLimits, OffsetsRotationAndToolLengthCount) {
  // G92 X10 and a quarter turn: program X runs along the machine's Y.
  const WorkpieceFrame frame{.g5x_mm = {200, 150, -50}, .g92_mm = {10, 0, 0}, .rotation_deg = 90};
  EXPECT_EQ(found(MotionList().feed({139, 0, 0}), frame), Texts{});
  EXPECT_EQ(
      found(MotionList().feed({142, 0, 0}), frame),
      Texts{"1: axis Y is sent to 302.000 mm, 2.000 mm beyond its limit of 300.000 mm (machine "
            "coordinates)"});
  MotionList high;
  high.feed({0, 0, 20});
  Motion& last = high.last();
  last.tool_offset_mm = {0, 0, 40};
  EXPECT_EQ(found(high, kMiddle),
            Texts{"1: axis Z is sent to 10.000 mm, 10.000 mm beyond its limit of 0.000 mm (machine "
                  "coordinates)"});
}

TEST(AxisLimits, ASecondaryAxisHasItsOffsets) {
  MachineLimits limits = box_limits();
  limits.axes[8] = {.present = true, .min = -50, .max = 5};
  FindingLog log;
  AxisLimitCheck check(limits, log);
  WorkpieceFrame frame = kMiddle;
  frame.offset_uvw_mm = {0, 0, -30};
  check.set_frame(frame);
  MotionList program;
  program.feed({0, 0, 0});
  program.last().from_uvw_mm = {0, 0, 5};
  program.last().to_uvw_mm = {0, 0, -20};
  check.check(program.last(), {});
  EXPECT_TRUE(log.kept().empty());
  program.last().tool_offset_uvw_mm = {0, 0, -2};
  check.check(program.last(), {});
  ASSERT_EQ(log.kept().size(), 1u);
  EXPECT_EQ(log.kept()[0].text,
            "axis W is sent to -52.000 mm, 2.000 mm beyond its limit of -50.000 mm (machine "
            "coordinates)");
}

TEST(AxisLimits, AnArcReachesFartherThanItsEnds) {
  MotionList program;
  program.at({195, 10, 0}).arc({195, -10, 0}, {195, 0, 0}, {0, 0, 1}, -kPi);
  EXPECT_EQ(
      found(program, kMiddle),
      Texts{"1: axis X is sent to 405.000 mm, 5.000 mm beyond its limit of 400.000 mm (machine "
            "coordinates)"});
  // The other way round it stays inside.
  MotionList back;
  back.at({195, 10, 0}).arc({195, -10, 0}, {195, 0, 0}, {0, 0, 1}, kPi);
  EXPECT_EQ(found(back, kMiddle), Texts{});
}

TEST(AxisLimits, RotaryAxesInDegrees) {
  MotionList program;
  program.feed({1, 0, 0});
  program.last().to_abc_deg = {91, 0, 0};
  EXPECT_EQ(found(program, kMiddle), Texts{"1: axis A is sent to 91.000 degrees, 1.000 degrees "
                                           "beyond its limit of 90.000 degrees (machine "
                                           "coordinates)"});
}

TEST(AxisLimits, WithoutLimitsNothingIsFound) {
  FindingLog log;
  AxisLimitCheck check(MachineLimits::small_mill(), log);
  const MotionList program = MotionList().feed({1e6, 0, 0});
  check.check(program.list()[0], {});
  EXPECT_TRUE(log.kept().empty());
}

}  // namespace
}  // namespace kerf
