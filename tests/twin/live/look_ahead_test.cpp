// What is told before it happens.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "tests/twin/live/cutter_shop.h"
#include "twin/job/fixtures.h"
#include "twin/program/session_parts.h"

namespace kerf {
namespace {

TEST(LookAhead, WhatTheProgramWouldDoIsToldBeforeItHappens) {
  MotionList program;
  program.at({-5, 20, 5}).tool(1).spindle(true).feed_rate(600);
  program.traverse({-3, 20, 5}).feed({-3, 20, -2}).feed({30, 20, -2});
  program.traverse({30, 30, -2}).traverse({30, 30, 5});
  const RunningMachine machine(program.list());
  LiveCutOptions options;
  options.guard_s = 2;
  Watch watch(options, &program);
  watch.run(machine, 100, true);
  ASSERT_EQ(watch.warnings.size(), 1U);
  const AheadWarning& warning = watch.warnings[0].warning;
  EXPECT_EQ(warning.finding.id, FindingId::kRapidContact);
  EXPECT_EQ(warning.finding.source.line, 5U);
  // At least two seconds before it happens.
  double happens_s = 0;
  for (const TimedMotion& m : machine.list()) {
    if (m.motion.source.line == 5) happens_s = m.step.start_s;
  }
  EXPECT_NEAR(*warning.finding.time_s, happens_s, 0.05);
  EXPECT_GT(happens_s - watch.warnings[0].at_s, 1.9);
  // And it did happen.
  EXPECT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kRapidContact});
}

TEST(LookAhead, NothingIsToldFartherAheadThanAskedFor) {
  // Half a minute through the air, in one move; and then one that meets the workpiece at its end.
  MotionList program;
  program.at({-20, 20, 5}).tool(1).spindle(true).feed_rate(60);
  program.traverse({-20, 20, 6}).feed({10, 20, 6}).traverse({10, 20, -2}).traverse({10, 20, 5});
  program.spindle(false).feed({12, 20, 5}).feed({12, 20, -1});
  const RunningMachine machine(program.list());
  for (const double guard_s : {3.0, 10.0}) {
    LiveCutOptions options;
    options.guard_s = guard_s;
    Watch watch(options, &program);
    watch.run(machine, 20, true);
    ASSERT_EQ(watch.warnings.size(), 2U);
    for (const Watch::Told& told : watch.warnings) {
      EXPECT_LE(told.warning.in_s, guard_s);
      EXPECT_GT(told.warning.in_s, guard_s - 0.1) << told.at_s;
      EXPECT_NEAR(told.warning.t_s, told.at_s, 0.06);
    }
  }
}

TEST(LookAhead, AFixtureInTheWayIsToldBeforeItIsMet) {
  Diagnostics diagnostics;
  const std::vector<FixtureSpec> specs{parse_fixture("clamp=box:20,15,-2:24,25,6").value()};
  for (const double height_mm : {5.0, 6.3}) {
    MotionList program;
    program.at({5, 20, 20}).tool(1).spindle(true).feed_rate(600);
    program.feed({5, 20, 12}).traverse({5, 20, height_mm}).traverse({35, 20, height_mm});
    const RunningMachine machine(program.list());
    LiveCutOptions options;
    options.guard_s = 0.5;
    options.checks.collisions.fixtures = load_fixtures(specs, diagnostics);
    ASSERT_TRUE(options.checks.collisions.fixtures);
    Watch watch(options, &program);
    watch.run(machine, 100, true);
    if (height_mm > 6) {
      EXPECT_TRUE(watch.warnings.empty());
      continue;
    }
    ASSERT_EQ(watch.warnings.size(), 1U);
    const AheadWarning& warning = watch.warnings[0].warning;
    EXPECT_EQ(warning.finding.id, FindingId::kFixtureContact);
    // The cutter of 4 mm meets the side at X20.
    EXPECT_NEAR(warning.finding.position_mm->x, 18, 0.01);
    EXPECT_GT(warning.in_s, 0.4);
    EXPECT_LE(warning.in_s, 0.5);
    EXPECT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kFixtureContact});
  }
}

TEST(LookAhead, WhatIsDearAheadOfAMachineItsPositionsDoNotWaitFor) {
  // The first contact of a fine helix, with a spindle that stands: seconds.
  MotionList program;
  program.at({5, 20, 5}).tool(1).spindle(false).feed_rate(3000);
  program.traverse({5, 20, 3}).traverse({20, 20, 2});
  program.arc({20, 20, -4}, {15, 20, -1}, {0, 0, 1}, 2 * kPi * 6);
  auto stock = block();
  FindingLog log;
  LiveCutOptions options;
  options.frame.tool_length = ToolLengthFrom::kNone;
  options.guard_s = 300;
  LiveCutter cutter(*stock, cutters(), log, options,
                    std::make_unique<ListedProgram>(program.list()));
  const RunningMachine machine(program.list());
  const double begun_s = thread_cpu_s();
  std::size_t warnings = 0;
  AxisSample sample = machine.sample(0.01, true);
  for (int i = 0; warnings == 0 && i < 3000; ++i) {
    cutter.take(sample, 0.01 * i, false);
    cutter.look();
    warnings = cutter.take_warnings().size();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(warnings, 1U);
  EXPECT_LT(thread_cpu_s() - begun_s, 0.3);
}

TEST(LookAhead, TheGuardLooksAtTheWorkpieceAsItReallyIs) {
  // The program rapids through a slot that it has cut before; this machine was elsewhere meanwhile.
  MotionList program;
  program.at({-5, 20, 5}).tool(1).spindle(true).feed_rate(1200);
  program.traverse({-5, 20, -1}).feed({30, 20, -1}).traverse({30, 20, 5});
  for (int i = 0; i < 6; ++i) program.traverse({30 - i % 2, 20, 5}).dwell(0.5);
  program.traverse({-5, 20, 5}).traverse({-5, 20, -1}).traverse({29, 20, -1});
  const RunningMachine machine(program.list());
  Watch good({}, &program);
  good.run(machine, 100, true);
  EXPECT_TRUE(good.warnings.empty());
  for (const Finding& f : good.log().kept()) ADD_FAILURE() << f.source.line << message_of(f);
  LiveCutOptions options;
  options.guard_s = 1.5;
  Watch bad(options, &program);
  const double end_s = machine.duration_s();
  std::vector<AheadWarning> warnings;
  for (double t = 0; t < end_s; t += 0.01) {
    // In half of the slot it was above the block: somebody lifted the tool.
    AxisSample sample = machine.sample(t, true);
    if (machine.at(t).motion.source.line == 3 && machine.tip(t).x > 10) sample.position[2] += 8;
    bad.cutter().take(sample, t, false);
    bad.cutter().look();
    for (AheadWarning& w : bad.cutter().take_warnings()) warnings.push_back(std::move(w));
  }
  ASSERT_GE(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].finding.id, FindingId::kRapidContact);
}

}  // namespace
}  // namespace kerf
