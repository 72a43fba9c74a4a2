// Machines beside their path, with another tool, by another program.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/twin/live/cutter_shop.h"

namespace kerf {
namespace {

TEST(PathWatch, AMachineBesideThePathIsFoundAndWhatItDoesIsCut) {
  const MotionList program = pocket();
  const RunningMachine machine(program.list());
  Watch watch({}, &program);
  double t = 0;  // until it is well within the pocket
  for (; t < 2.0; t += 0.01) watch.cutter().take(machine.sample(t), t, false);
  const double before = watch.removed_mm3();
  AxisSample beside = machine.sample(t);
  beside.position[2] -= 1.5;
  for (int i = 0; i < 20; ++i, t += 0.01) watch.cutter().take(beside, t, false);
  EXPECT_GT(watch.removed_mm3(), before + 1);
  ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kOffPath});
  EXPECT_NEAR(watch.log().kept()[0].depth_mm.value_or(0), 1.5, 0.01);
  EXPECT_GT(watch.log().kept()[0].source.line, 0U);
}

TEST(PathWatch, TheWrongToolIsFound) {
  const MotionList program = pocket();
  const RunningMachine machine(program.list());
  Watch watch({}, &program);
  for (double t = 0; t < 1.0; t += 0.01) {
    AxisSample sample = machine.sample(t);
    sample.tool = 2;
    watch.cutter().take(sample, t, false);
  }
  const std::vector<FindingId> told = watch.ids();
  EXPECT_TRUE(std::ranges::find(told, FindingId::kToolMismatch) != told.end());
  EXPECT_EQ(watch.log().kept()[0].text,
            "the machine has tool 2 in the spindle where the program has tool 1");
}

/// It stands where the program is going to feed from, its tool in the rack; and the sample that has
/// the new tool may be the first that has moved.
TEST(PathWatch, AMachineThatStandsAtTheBeginningMayHaveAnyTool) {
  MotionList program;
  program.at({5, 20, 2}).tool(1).spindle(true).feed_rate(1200);
  program.feed({5, 20, -2}).feed({35, 20, -2}).traverse({35, 20, 5});
  const auto wanted = dry_run(program.list());
  const RunningMachine machine(program.list());
  const double end_s = machine.duration_s();
  for (const int before : {0, 2}) {
    for (const double hidden_s : {0.0, 0.004}) {
      SCOPED_TRACE(testing::Message() << "tool " << before << ", " << hidden_s << " s");
      Watch watch({}, &program);
      for (int i = 0; i < 200; ++i) watch.see({5, 20, 2}, 0.01 * i, before);
      EXPECT_TRUE(watch.look_ahead().empty());
      for (double t = hidden_s; t < end_s + 0.02; t += 0.01) {
        watch.cutter().take(machine.sample(std::min(t, end_s)), 2 + t, false);
        EXPECT_TRUE(watch.look_ahead().empty());
      }
      for (const Finding& finding : watch.log().kept()) ADD_FAILURE() << message_of(finding);
      EXPECT_LT(worst_difference_mm(watch.stock(), *wanted), 2e-5);
    }
  }
  // Nobody changes it: told as soon as the machine has gone a mm with it, and what comes of it.
  Watch watch({}, &program);
  std::vector<AheadWarning> warnings;
  for (double t = 0; t < end_s; t += 0.01) {
    AxisSample sample = machine.sample(t);
    sample.tool = 0;
    watch.cutter().take(sample, t, false);
    for (AheadWarning& warning : watch.look_ahead()) warnings.push_back(std::move(warning));
  }
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings[0].finding.id, FindingId::kToolUndefined);
  EXPECT_LT(warnings[0].t_s, 0.5);
  const std::vector<FindingId> told = watch.ids();
  EXPECT_TRUE(std::ranges::find(told, FindingId::kToolMismatch) != told.end());
}

TEST(PathWatch, AMachineThatCutsAndIsNeverOnThePathRunsAnotherProgram) {
  const MotionList program = two_slots();
  const RunningMachine machine(program.list());
  for (const double beside_mm : {0.0, 1.5}) {
    Watch watch({}, &program);
    for (int i = 0; i < 600; ++i) {
      AxisSample sample = machine.sample(std::min(0.01 * i, machine.duration_s()));
      sample.set(1, sample.position[1] + beside_mm);
      watch.cutter().take(sample, 0.01 * i, false);
    }
    const std::vector<FindingId> wanted =
        beside_mm > 0 ? std::vector{FindingId::kNotThisProgram} : std::vector<FindingId>{};
    EXPECT_EQ(watch.ids(), wanted) << beside_mm;
  }
}

}  // namespace
}  // namespace kerf
