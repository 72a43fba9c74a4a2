// Machines that run already when they are first seen.
#include <gtest/gtest.h>

#include "tests/twin/live/cutter_shop.h"

namespace kerf {
namespace {

TEST(LateJoin, AMachineThatRunsAlreadyIsJoinedWhereItIs) {
  MotionList program;
  program.at({-5, 20, 5}).tool(1).spindle(true).feed_rate(600);
  program.traverse({-3, 20, 5}).feed({-3, 20, -2});
  for (int i = 1; i <= 60; ++i) program.feed({i % 2 ? 43.0 : -3.0, 20.0 - 0.2 * i, -2});
  program.traverse({0, 0, 5});
  const auto wanted = dry_run(program.list());
  const RunningMachine machine(program.list());
  LiveCutOptions options;
  options.reopen = [&] { return std::make_unique<ListedProgram>(program.list()); };
  Watch watch(options, &program);
  const double end_s = machine.duration_s();
  ASSERT_GT(end_s, 100);
  for (double t = 0.6 * end_s; t < end_s + 0.02; t += 0.01) {
    watch.cutter().take(machine.sample(std::min(t, end_s), true), t, false);
  }
  EXPECT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kLateStart});
  watch.removed_mm3();
  EXPECT_LT(worst_difference_mm(watch.stock(), *wanted), 2e-5);
  // What it cut before is not put down to it.
  EXPECT_LT(watch.cutter().stage().tools()[0].cut_s, 0.45 * end_s);
}

TEST(LateJoin, WhatCameBeforeAMachineThatIsFoundAtOnceIsCutToo) {
  const MotionList program = two_slots();
  const auto wanted = dry_run(program.list());
  const RunningMachine machine(program.list());
  const double end_s = machine.duration_s();
  double second_slot_s = 0;
  for (const TimedMotion& m : machine.list()) {
    if (m.motion.source.line == 8) second_slot_s = m.step.start_s;
  }
  // Within the first slot; within the second, whose line the machine names.
  for (const double begin_s : {2.0, second_slot_s + 0.5}) {
    for (const bool with_line : {true, false}) {
      if (!with_line && begin_s > 4) continue;
      for (const JoinedLate policy : {JoinedLate::kCut, JoinedLate::kKeep}) {
        SCOPED_TRACE(testing::Message() << begin_s << " s, lines " << with_line);
        LiveCutOptions options;
        options.joined_late = policy;
        Watch watch(options, &program);
        for (double t = begin_s; t < end_s + 0.02; t += 0.01) {
          watch.cutter().take(machine.sample(std::min(t, end_s), with_line), t, false);
          watch.cutter().look();
        }
        const double missing_mm3 =
            watch.removed_mm3() - (wanted->blank_mm3() - wanted->remaining_mm3());
        ASSERT_FALSE(watch.ids().empty());
        EXPECT_EQ(watch.ids()[0], FindingId::kLateStart);
        if (policy == JoinedLate::kCut) {
          EXPECT_EQ(watch.ids().size(), 1U) << message_of(watch.log().kept().back());
          EXPECT_LT(worst_difference_mm(watch.stock(), *wanted), 2e-5);
        } else {
          // The rapid back cuts the first slot then, and it shows.
          EXPECT_LT(missing_mm3, begin_s > 4 ? -10 : 1e-3);
          EXPECT_EQ(watch.ids()[1], FindingId::kRapidContact);
          EXPECT_NE(watch.log().kept()[0].text.find("is not cut"), std::string::npos);
        }
      }
    }
  }
}

TEST(LateJoin, AMachineThatHasBeenWatchedSinceBeforeIsNotLate) {
  MotionList program = two_slots();
  const RunningMachine machine(program.list());
  Watch watch({}, &program);
  // It stands elsewhere for a minute, and is first seen on the path 1 s after the program's start.
  for (int i = 0; i < 60; ++i) watch.see({-40, -40, 50}, i);
  for (double t = 1; t < machine.duration_s(); t += 0.01) {
    watch.cutter().take(machine.sample(t), 60 + t, false);
  }
  for (const FindingId id : watch.ids()) EXPECT_NE(id, FindingId::kLateStart);
}

}  // namespace
}  // namespace kerf
