// What a watched machine removes: along its program, by chords, across gaps.
#include <gtest/gtest.h>

#include <vector>

#include "tests/twin/live/cutter_shop.h"

namespace kerf {
namespace {

TEST(WayCutter, WithAProgramTheWorkpieceIsThatOfTheDryRun) {
  const MotionList program = pocket();
  const auto wanted = dry_run(program.list());
  const RunningMachine machine(program.list());
  for (const double rate_hz : {1000.0, 100.0, 10.0, 5.0}) {
    Watch watch({}, &program);
    watch.run(machine, rate_hz);
    EXPECT_LT(worst_difference_mm(watch.stock(), *wanted), 2e-5) << rate_hz << " Hz";
    EXPECT_EQ(watch.ids(), std::vector<FindingId>{}) << rate_hz << " Hz";
    EXPECT_EQ(watch.cutter().facts().off_path, 0U);
    EXPECT_EQ(watch.cutter().facts().tool_changes, 1U);
  }
}

TEST(WayCutter, WithoutOneChordsAreCutAndLieAsMuchAsTheyMust) {
  const MotionList program = pocket();
  const auto wanted = dry_run(program.list());
  const RunningMachine machine(program.list());
  LiveCutOptions options;
  options.gap_s = 1;
  Watch fast(options);
  fast.run(machine, 1000);
  EXPECT_NEAR(fast.stock().remaining_mm3(), wanted->remaining_mm3(), 2);
  Watch slow(options);
  slow.run(machine, 10);
  // 5 mm between samples: corners and arcs are cut short.
  EXPECT_GT(std::abs(slow.stock().remaining_mm3() - wanted->remaining_mm3()), 20);
  EXPECT_GT(worst_difference_mm(slow.stock(), *wanted), 0.5);
}

TEST(WayCutter, AStraightWayIsCutExactly) {
  Watch watch;
  watch.see({10, 20, 1}, 0);
  watch.see({10, 20, -1}, 0.1);
  EXPECT_NEAR(watch.removed_mm3(), kPi * 4, 0.3);
  watch.see({30, 20, -1}, 0.2);
  EXPECT_NEAR(watch.removed_mm3(), kPi * 4 + 80, 0.3);
  // Standing still, and going back over what is cut, removes nothing.
  const double removed = watch.removed_mm3();
  watch.see({30, 20, -1}, 0.3);
  watch.see({10, 20, -1}, 0.4);
  EXPECT_EQ(watch.removed_mm3(), removed);
}

/// A machine out of sight for `gap_s` from `from_s` on.
void run_with_gap(Watch& watch, const RunningMachine& machine, double from_s, double gap_s,
                  bool with_line) {
  const double end_s = machine.duration_s();
  for (int i = 0; i <= static_cast<int>(end_s * 100) + 1; ++i) {
    const double t = i / 100.0;
    if (t > from_s && t < from_s + gap_s && t < end_s) continue;
    watch.cutter().take(machine.sample(std::min(t, end_s), with_line), t, false);
    watch.cutter().look();
  }
  watch.cutter().finish();
}

/// Holes with pecks: between them the tool comes out, and goes down again by a rapid.
MotionList pecks() {
  MotionList program;
  program.at({-5, -5, 5}).tool(1).spindle(true).feed_rate(600);
  for (int hole = 0; hole < 2; ++hole) {
    const double x = 10 + 15 * hole;
    program.traverse({x, 20, 5}).traverse({x, 20, 1});
    for (int peck = 1; peck <= 4; ++peck) {
      if (peck > 1) program.traverse({x, 20, 1.3 - 2 * (peck - 1)});
      program.feed({x, 20, 1.0 - 2 * peck}).traverse({x, 20, 1});
    }
    program.traverse({x, 20, 5});
  }
  return program;
}

TEST(WayCutter, AfterAGapOnThePathTheProgramIsCut) {
  struct Case {
    MotionList program;
    double gap_s;
  };
  for (const Case& c :
       {Case{pocket(), 0.7}, Case{pocket(), 2.5}, Case{pecks(), 0.7}, Case{pecks(), 1.5}}) {
    const RunningMachine machine(c.program.list());
    const auto wanted = dry_run(c.program.list());
    int gaps = 0;
    for (double from_s = 0.4; from_s + c.gap_s + 0.4 < machine.duration_s(); from_s += 0.17) {
      for (const bool with_line : {false, true}) {
        SCOPED_TRACE(testing::Message() << c.gap_s << " s from " << from_s << ", " << with_line);
        Watch watch({}, &c.program);
        run_with_gap(watch, machine, from_s, c.gap_s, with_line);
        EXPECT_LT(worst_difference_mm(watch.stock(), *wanted), 2e-5);
        for (const Finding& finding : watch.log().kept()) {
          EXPECT_EQ(finding.id, FindingId::kSourceGap) << message_of(finding);
          EXPECT_NE(finding.text.find("as the program has it"), std::string::npos) << finding.text;
          ++gaps;
        }
      }
    }
    EXPECT_GT(gaps, 20);
  }
}

TEST(WayCutter, AWayThatTheProgramCannotHaveGoneInAGapIsNotCut) {
  // 0.6 s out of sight, and it is where the program comes after 10 s.
  const MotionList program = pocket();
  const RunningMachine machine(program.list());
  Watch watch({}, &program);
  for (int i = 0; i < 200; ++i)
    watch.cutter().take(machine.sample(0.01 * i, true), 0.01 * i, false);
  const double before = watch.removed_mm3();
  for (int i = 0; i < 2; ++i) watch.cutter().take(machine.sample(9, true), 2.6 + 0.01 * i, false);
  EXPECT_NEAR(watch.removed_mm3(), before, 1.0);
  ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSourceGap});
  EXPECT_NE(watch.log().kept()[0].text.find("is not cut"), std::string::npos);
}

TEST(WayCutter, AStandingSpindleInTheStockIsFound) {
  Watch watch;
  watch.see({10, 20, 1}, 0, 1, false, 0);
  watch.see({10, 20, -1}, 0.1, 1, false, 0);
  watch.removed_mm3();
  ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSpindleOffContact});
}

TEST(WayCutter, ASpindleThatWasToldToStopStillTurnsWhileTheAxesComeToAStand) {
  // An abort: 40 ms later the axes stand. One that has stood for a second does not cut.
  Watch watch;
  for (int i = 0; i <= 20; ++i) watch.see({10 + 0.3 * i, 20, -1}, 0.01 * i, 1, false, 8000);
  for (int i = 1; i <= 4; ++i) watch.see({16 + 0.1 * i, 20, -1}, 0.2 + 0.01 * i, 1, false, 0);
  watch.removed_mm3();
  EXPECT_TRUE(watch.ids().empty());
  watch.see({16.4, 20, -1}, 0.5, 1, false, 0);
  watch.see({20, 20, -1}, 0.6, 1, false, 0);
  watch.removed_mm3();
  EXPECT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSpindleOffContact});
}

TEST(WayCutter, WhenASpindleStoppedThatWasOutOfSightNobodyKnows) {
  // 0.3 s without a reading, in which the machine was aborted: it came to a stand turning.
  Watch watch;
  for (int i = 0; i <= 20; ++i) watch.see({10 + 0.3 * i, 20, -1}, 0.01 * i, 1, false, 8000);
  watch.see({18, 20, -1}, 0.5, 1, false, 0);
  watch.removed_mm3();
  EXPECT_TRUE(watch.ids().empty());
  watch.see({20, 20, -1}, 0.7, 1, false, 0);
  watch.removed_mm3();
  EXPECT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSpindleOffContact});
}

}  // namespace
}  // namespace kerf
