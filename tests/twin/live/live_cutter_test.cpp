#include "twin/live/live_cutter.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/twin/live/live_shop.h"
#include "twin/session_parts.h"

namespace kerf {
namespace {

std::unique_ptr<ZMap> block() {
  ZMapOptions options;
  options.blank = parse_blank("box:0,0,-10:40,40,0").value();
  options.cell_mm = 0.1;
  return std::move(ZMap::create(options).value());
}

ToolSources cutters() {
  ToolSources sources;
  sources.arguments.push_back(std::move(parse_tool_argument("1=flat:4").value()));
  sources.arguments.push_back(std::move(parse_tool_argument("2=ball:6").value()));
  return sources;
}

/// The workpiece of a dry run.
std::unique_ptr<ZMap> dry_run(std::span<const Motion> program) {
  auto stock = block();
  ToolBook book(cutters(), ZMap::can_cut);
  FindingLog log;
  CutStage stage(*stock, book, log, TimelineOptions{});
  stage.take(program);
  stage.finish();
  return stock;
}

/// A machine that is watched.
class Watch {
 public:
  explicit Watch(LiveCutOptions options = {}, const MotionList* program = nullptr)
      : stock_(block()) {
    options.frame.tool_length = length;
    std::unique_ptr<Program> listed;
    if (program) listed = std::make_unique<ListedProgram>(program->list());
    options.wait_for_program = true;
    cutter_ = std::make_unique<LiveCutter>(*stock_, cutters(), log_, options, std::move(listed));
  }
  void run(const RunningMachine& machine, double rate_hz, bool with_line = false) {
    const double end_s = machine.duration_s();
    for (int i = 0; i <= static_cast<int>(end_s * rate_hz) + 1; ++i) {
      const double t = std::min(end_s, i / rate_hz);
      cutter_->take(machine.sample(t, with_line), i / rate_hz, false);
      cutter_->look();
      for (AheadWarning& warning : cutter_->take_warnings()) {
        warnings.push_back({std::move(warning), t});
      }
    }
    cutter_->finish();
  }
  void see(Vec3 tip, double t_s, int tool = 1, bool lost = false,
           double rpm = std::numeric_limits<double>::quiet_NaN()) {
    AxisSample sample;
    for (int i = 0; i < 3; ++i) sample.set(static_cast<std::size_t>(i), tip[i]);
    sample.tool = tool;
    sample.spindle_rpm = rpm;
    cutter_->take(sample, t_s, lost);
  }
  double removed_mm3() {
    cutter_->look();
    return stock_->blank_mm3() - stock_->remaining_mm3();
  }
  std::vector<FindingId> ids() const {
    std::vector<FindingId> out;
    for (const Finding& f : log_.kept()) out.push_back(f.id);
    return out;
  }
  LiveCutter& cutter() { return *cutter_; }
  const ZMap& stock() const { return *stock_; }
  const FindingLog& log() const { return log_; }

  /// Positions are those of the tip.
  static inline ToolLengthFrom length = ToolLengthFrom::kNone;
  struct Told {
    AheadWarning warning;
    double at_s;
  };
  std::vector<Told> warnings;

 private:
  std::unique_ptr<ZMap> stock_;
  FindingLog log_;
  std::unique_ptr<LiveCutter> cutter_;
};

double worst_difference_mm(const ZMap& a, const ZMap& b) {
  double worst = 0;
  for (int j = 0; j < a.ny(); ++j) {
    for (int i = 0; i < a.nx(); ++i) {
      worst = std::max(worst, std::abs(static_cast<double>(a.height_mm(i, j) - b.height_mm(i, j))));
    }
  }
  return worst;
}

MotionList pocket() {
  MotionList program;
  program.at({-5, -5, 5}).tool(1).spindle(true).feed_rate(3000);
  program.traverse({10, 10, 5}).feed({10, 10, -2});
  for (int i = 0; i < 8; ++i) {
    program.feed({i % 2 ? 10.0 : 30.0, 10 + 2.0 * i, -2});
    program.feed({i % 2 ? 10.0 : 30.0, 12 + 2.0 * i, -2});
  }
  program.arc({30, 26, -4}, {20, 26, -2}, {0, 0, 1}, 2 * kPi + kPi);
  program.traverse({30, 26, 5}).tool(2).spindle(true);
  program.traverse({20, 20, 5}).feed({20, 20, -5}).feed({35, 35, -3}).traverse({35, 35, 5});
  return program;
}

TEST(LiveCutter, WithAProgramTheWorkpieceIsThatOfTheDryRun) {
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

TEST(LiveCutter, WithoutOneChordsAreCutAndLieAsMuchAsTheyMust) {
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

TEST(LiveCutter, AStraightWayIsCutExactly) {
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

TEST(LiveCutter, GapsAreMarkedCutOrIgnored) {
  struct Case {
    GapPolicy policy;
    bool cut;
    std::size_t findings;
  };
  for (const Case& c : {Case{GapPolicy::kMark, false, 1}, Case{GapPolicy::kCut, true, 1},
                        Case{GapPolicy::kIgnore, false, 0}}) {
    LiveCutOptions options;
    options.gap = c.policy;
    Watch watch(options);
    watch.see({10, 20, -1}, 0);
    watch.see({10.01, 20, -1}, 0.7);  // too little to speak of
    const double before = watch.removed_mm3();
    watch.see({30, 20, -1}, 1.3, 2);
    EXPECT_EQ(watch.removed_mm3() > before + 1, c.cut);
    ASSERT_EQ(watch.log().kept().size(), c.findings);
    EXPECT_EQ(watch.cutter().facts().gaps, 1U);
    if (c.findings == 0) continue;
    EXPECT_EQ(watch.log().kept()[0].id, FindingId::kSourceGap);
    const std::string& text = watch.log().kept()[0].text;
    EXPECT_EQ(text.substr(0, 60), "no positions for 0.600 s, the machine is 19.99 mm further on");
    EXPECT_NE(text.find("the tool was changed meanwhile, from 1 to 2"), text.npos) << text;
  }
}

TEST(LiveCutter, LostSamplesAndImpossibleJumpsAreGapsToo) {
  LiveCutOptions options;
  options.most_mm_per_s = 100;
  Watch watch(options);
  watch.see({10, 20, -1}, 0);
  watch.see({11, 20, -1}, 0.01);  // 100 mm/s
  EXPECT_TRUE(watch.ids().empty());
  watch.see({21, 20, -1}, 0.02);  // 1000 mm/s
  ASSERT_EQ(watch.ids().size(), 1U);
  EXPECT_EQ(watch.log().kept()[0].text.substr(0, 45),
            "positions jump by 10.00 mm within 0.010 s, fa");
  EXPECT_EQ(watch.log().kept()[0].severity, Severity::kWarning);
  watch.see({21.5, 20, -1}, 0.03, 1, true);
  EXPECT_EQ(watch.ids().size(), 1U) << "one sample in a quick row is no gap";
  watch.see({22.5, 20, -1}, 0.14, 1, true);
  EXPECT_EQ(watch.ids().size(), 2U);
  // A machine that keeps its speed is only faster than was said: it is cut after the first jump.
  const double before = watch.removed_mm3();
  for (int i = 0; i < 5; ++i) watch.see({22.5 - 12.0 * i, 24, -1}, 0.15 + 0.01 * i);
  EXPECT_EQ(watch.ids().size(), 3U);
  EXPECT_GT(watch.removed_mm3(), before + 20);
}

TEST(LiveCutter, AWildSampleIsToldAndNotCut) {
  double sound_mm3 = 0;
  for (const int wild : {0, 1, 2}) {
    LiveCutOptions options;
    options.most.per_s2 = 5000;
    Watch watch(options);
    for (int i = 0; i < 100; ++i) {
      const bool is_wild = wild > 0 && i >= 50 && i < 50 + wild;
      watch.see({5 + 0.1 * i, is_wild ? 39.0 : 5.0, -1}, 0.01 * i);
    }
    watch.cutter().finish();
    EXPECT_EQ(watch.cutter().facts().samples, 100U);
    EXPECT_EQ(watch.cutter().facts().wild, static_cast<std::uint64_t>(wild));
    if (wild == 0) {
      sound_mm3 = watch.removed_mm3();
      EXPECT_TRUE(watch.ids().empty());
      continue;
    }
    EXPECT_NEAR(watch.removed_mm3(), sound_mm3, 1e-6);
    ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSourceGap});
    EXPECT_EQ(watch.log().kept()[0].text.substr(0, 29), "Y reads 39 mm, 34.00 mm away ");
  }
}

TEST(LiveCutter, WhatWasHeldUpAndComesInABurstIsNoJump) {
  LiveCutOptions options;
  options.most_mm_per_s = 60;
  Watch watch(options);
  // 60 mm/s. For 48 ms the thread of the machine stands, then it catches up.
  double x = 10;
  for (int i = 0; i < 10; ++i) watch.see({x += 0.3, 20, -1}, 0.005 * i);
  for (int i = 10; i < 19; ++i) watch.see({x, 20, -1}, 0.005 * i);
  watch.see({x += 2.9, 20, -1}, 0.0951);
  // The same of who reads it: stamped, held up, read, and stamped again at once.
  watch.see({x += 1.7, 20, -1}, 0.1);
  watch.see({x += 1.2, 20, -1}, 0.1);
  EXPECT_TRUE(watch.ids().empty());
  EXPECT_EQ(watch.cutter().facts().gaps, 0U);
  watch.see({x += 4.7, 20, -1}, 0.101);  // 51 ms times 60 mm/s times 1.5 are 4.59 mm
  EXPECT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSourceGap});
}

TEST(LiveCutter, AJumpFarFromTheWorkpieceIsHomingAndOnlyANote) {
  LiveCutOptions options;
  options.most_mm_per_s = 100;
  Watch watch(options);
  watch.see({0, 0, 50}, 0, 0);
  watch.see({0, 0, 75.4}, 0.001, 0);
  watch.see({-5, -5, 75.4}, 0.1, 0);  // in the air, with nothing in the spindle
  ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSourceGap});
  EXPECT_EQ(watch.log().kept()[0].severity, Severity::kNote);
  EXPECT_EQ(watch.cutter().facts().jumps, 1U);
  EXPECT_EQ(watch.cutter().facts().gaps, 0U);
}

TEST(LiveCutter, PositionsOfAnotherMachineAreSuspected) {
  LiveCutOptions options;
  options.timeline.limits.axes[0].present = true;
  options.timeline.limits.axes[0].min = -250;
  options.timeline.limits.axes[0].max = 250;
  Watch watch(options);
  for (int i = 0; i < 30; ++i) watch.see({612.3, 20, 60}, 0.1 * i);
  ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kAxisLimit});
  EXPECT_EQ(watch.log().kept()[0].text,
            "X stands at 612.30 mm, beyond the limits of the machine (-250 to 250 mm): are these "
            "positions of another machine, or in another unit?");
}

TEST(LiveCutter, AnAxisThatTurnsIsToldOnceWhereTheModelCannotFollow) {
  Watch watch;
  double t_s = 0;
  const auto at = [&](double x, double c_deg) {
    AxisSample sample;
    for (std::size_t i = 0; i < 6; ++i) sample.set(i, 0);
    sample.set(0, x);
    sample.set(5, c_deg);
    sample.tool = 1;
    watch.cutter().take(sample, t_s += 0.1, false);
  };
  // It may stand anywhere.
  at(0, 90);
  at(1, 90.005);
  EXPECT_TRUE(watch.ids().empty());
  at(2, 91.5);
  at(3, 95);
  EXPECT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kRotaryIgnored});
  EXPECT_NE(watch.log().kept().front().text.find("C has turned by 1.50 degrees"), std::string::npos)
      << watch.log().kept().front().text;
}

TEST(LiveCutter, AToolWhoseLengthNobodyTellsIsNamedOnce) {
  LiveCutOptions options;
  auto stock = block();
  FindingLog log;
  LiveCutter cutter(*stock, cutters(), log, options, nullptr);
  AxisSample sample;
  for (std::size_t i = 0; i < 3; ++i) sample.set(i, 50);
  for (const int tool : {0, 1, 1, 1}) {
    sample.tool = tool;
    cutter.take(sample, 0, false);
  }
  ASSERT_EQ(log.kept().size(), 1U);
  EXPECT_EQ(log.kept()[0].id, FindingId::kLengthUnknown);
  EXPECT_EQ(log.kept()[0].tool, 1);
}

TEST(LiveCutter, APositionThatIsMissingIsNamedAndNothingIsCut) {
  Watch watch;
  AxisSample sample;
  sample.set(0, 20);
  sample.set(2, -1);
  watch.cutter().take(sample, 0, false);
  EXPECT_FALSE(watch.cutter().place().known);
  EXPECT_EQ(watch.cutter().place().missing_axes, "Y");
  EXPECT_EQ(watch.cutter().facts().incomplete, 1U);
  EXPECT_EQ(watch.removed_mm3(), 0);
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

TEST(LiveCutter, AfterAGapOnThePathTheProgramIsCut) {
  struct Case {
    MotionList program;
    double gap_s;
  };
  for (const Case& c : {Case{pocket(), 0.7}, Case{pecks(), 0.7}, Case{pecks(), 1.5}}) {
    const RunningMachine machine(c.program.list());
    const auto wanted = dry_run(c.program.list());
    int gaps = 0;
    for (double from_s = 0.4; from_s + c.gap_s + 0.4 < machine.duration_s(); from_s += 0.17) {
      // What is missing while the tool is changed is no way.
      if (machine.at(from_s).motion.tool != machine.at(from_s + c.gap_s).motion.tool) continue;
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

TEST(LiveCutter, AWayThatTheProgramCannotHaveGoneInAGapIsNotCut) {
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

TEST(LiveCutter, AStandingSpindleInTheStockIsFound) {
  Watch watch;
  watch.see({10, 20, 1}, 0, 1, false, 0);
  watch.see({10, 20, -1}, 0.1, 1, false, 0);
  watch.removed_mm3();
  ASSERT_EQ(watch.ids(), std::vector<FindingId>{FindingId::kSpindleOffContact});
}

TEST(LiveCutter, ASpindleThatWasToldToStopStillTurnsWhileTheAxesComeToAStand) {
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

TEST(LiveCutter, WhenASpindleStoppedThatWasOutOfSightNobodyKnows) {
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

TEST(LiveCutter, AMachineBesideThePathIsFoundAndWhatItDoesIsCut) {
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

TEST(LiveCutter, WhereTheSourceNamesNoToolTheProgramDoes) {
  const MotionList program = pocket();
  const auto wanted = dry_run(program.list());
  const RunningMachine machine(program.list());
  LiveCutOptions options;
  options.frame.tool = 1;  // as a configuration has it
  Watch watch(options, &program);
  for (double t = 0; t < machine.duration_s() + 0.01; t += 0.01) {
    AxisSample sample = machine.sample(std::min(t, machine.duration_s()));
    sample.tool = AxisSample::kUnknown;
    watch.cutter().take(sample, t, false);
  }
  watch.removed_mm3();
  EXPECT_LT(worst_difference_mm(watch.stock(), *wanted), 2e-5);
  EXPECT_EQ(watch.ids(), std::vector<FindingId>{});
}

TEST(LiveCutter, TheWrongToolIsFound) {
  const MotionList program = pocket();
  const RunningMachine machine(program.list());
  Watch watch({}, &program);
  for (double t = 0; t < 1.0; t += 0.01) {
    AxisSample sample = machine.sample(t);
    sample.tool = 2;
    watch.cutter().take(sample, t, false);
  }
  ASSERT_FALSE(watch.ids().empty());
  EXPECT_EQ(watch.ids()[0], FindingId::kToolMismatch);
  EXPECT_EQ(watch.log().kept()[0].text,
            "the machine has tool 2 in the spindle where the program has tool 1");
}

TEST(LiveCutter, WhatTheProgramWouldDoIsToldBeforeItHappens) {
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

TEST(LiveCutter, NothingIsToldFartherAheadThanAskedFor) {
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

TEST(LiveCutter, WhatIsDearAheadOfAMachineItsPositionsDoNotWaitFor) {
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

TEST(LiveCutter, TheGuardLooksAtTheWorkpieceAsItReallyIs) {
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

TEST(LiveCutter, AMachineThatRunsAlreadyIsJoinedWhereItIs) {
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

/// A slot, one beside it, and a rapid back through the first.
MotionList two_slots() {
  MotionList program;
  program.at({5, 20, 5}).tool(1).spindle(true).feed_rate(900);
  program.traverse({5, 20, 3}).feed({5, 20, -3}).feed({35, 20, -3}).traverse({35, 20, 5});
  program.traverse({5, 30, 5}).feed({5, 30, -3}).feed({35, 30, -3}).traverse({35, 30, 5});
  program.traverse({35, 20, 5}).traverse({35, 20, -3}).traverse({5, 20, -3}).traverse({5, 20, 5});
  return program;
}

TEST(LiveCutter, WhatCameBeforeAMachineThatIsFoundAtOnceIsCutToo) {
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

TEST(LiveCutter, AMachineThatHasBeenWatchedSinceBeforeIsNotLate) {
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

TEST(LiveCutter, AMachineThatCutsAndIsNeverOnThePathRunsAnotherProgram) {
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

TEST(LiveCutter, TheWayToTheProgramsFirstPositionIsNotOffItsPath) {
  MotionList program;
  program.at({10, 20, 5}).tool(1).spindle(true).feed_rate(600);
  program.traverse({10, 20, 5}).traverse({10, 20, 1}).feed({10, 20, -2}).feed({30, 20, -2});
  std::vector<Motion> motions = program.list();
  motions[1].start_known = false;  // line 2: from wherever the machine was
  LiveCutOptions options;
  options.frame.tool_length = ToolLengthFrom::kNone;
  options.wait_for_program = true;
  auto stock = block();
  FindingLog log;
  LiveCutter cutter(*stock, cutters(), log, options, std::make_unique<ListedProgram>(motions));
  AxisSample sample;
  sample.tool = 1;
  sample.line = 2;
  for (int i = 0; i <= 500; ++i) {  // five seconds
    sample.set(0, -90 + 0.2 * i);
    sample.set(1, 20);
    sample.set(2, 5);
    cutter.take(sample, 0.01 * i, false);
  }
  sample.line = 3;
  sample.set(2, 3);
  cutter.take(sample, 5.02, false);
  EXPECT_TRUE(cutter.place().followed);
  EXPECT_TRUE(log.kept().empty());
  // On a line of which it is said to be, and nowhere near it, it is off the path.
  LiveCutter lost(*stock, cutters(), log, options, std::make_unique<ListedProgram>(motions));
  sample.set(0, -50);
  for (int i = 0; i <= 500; ++i) lost.take(sample, 0.01 * i, false);
  ASSERT_EQ(log.kept().size(), 1U);
  EXPECT_EQ(log.kept()[0].id, FindingId::kOffPath);
}

TEST(LiveCutter, ToolLengthsOfTheProgramApplyWhereTheyAreInForce) {
  // Machine coordinates: the tip plus the length in force.
  std::vector<Motion> motions = pocket().list();
  for (Motion& m : motions) m.tool_offset_mm = {0, 0, m.tool == 1 ? 30.0 : 50.0};
  // The longer tool reaches 20 mm farther down when it is put in; the program goes on from there.
  for (std::size_t i = 1; i + 1 < motions.size(); ++i) {
    if (motions[i].kind != MotionKind::kToolChange || motions[i].tool != 2) continue;
    motions[i - 1].to_mm.z = 50;
    motions[i].from_mm = motions[i].to_mm = motions[i + 1].from_mm = {30, 26, 30};
  }
  const auto wanted = dry_run(motions);
  const RunningMachine machine(motions);
  LiveCutOptions options;
  options.program_lengths = true;
  options.gap_s = 10;
  auto stock = block();
  FindingLog log;
  options.wait_for_program = true;
  LiveCutter cutter(*stock, cutters(), log, options, std::make_unique<ListedProgram>(motions));
  for (double t = 0; t < machine.duration_s() + 0.01; t += 0.01) {
    AxisSample sample = machine.sample(std::min(t, machine.duration_s()));
    sample.position[2] += sample.tool == 1 ? 30 : 50;
    cutter.take(sample, t, false);
  }
  cutter.look();
  EXPECT_LT(worst_difference_mm(*stock, *wanted), 2e-5);
  EXPECT_EQ(cutter.facts().off_path, 0U);
}

TEST(LiveCutter, AnOffsetThatIsNotTheToolsLengthMovesTheTipAlongAProgram) {
  const std::vector<Motion> motions = pocket().list();
  for (const double applied_mm : {50.0, 50.5, 45.0}) {
    // The table has 50 for tool 2; half a mm is wear.
    const double off_mm = applied_mm == 45 ? -5 : 0;
    std::vector<Motion> real = motions;
    for (Motion& m : real) {
      if (m.tool != 2) continue;
      m.from_mm.z += off_mm;
      m.to_mm.z += off_mm;
      m.arc.center_mm.z += off_mm;
    }
    const auto wanted = dry_run(real);
    const RunningMachine machine(motions);
    LiveCutOptions options;
    options.frame.table_length_mm = {{1, 30}, {2, 50}};
    options.gap_s = 10;
    options.wait_for_program = true;
    auto stock = block();
    FindingLog log;
    LiveCutter cutter(*stock, cutters(), log, options, std::make_unique<ListedProgram>(motions));
    for (double t = 0; t < machine.duration_s() + 0.01; t += 0.01) {
      AxisSample sample = machine.sample(std::min(t, machine.duration_s()));
      sample.tool_offset_z_mm = sample.tool == 1 ? 30 : applied_mm;
      sample.position[2] += sample.tool_offset_z_mm;
      cutter.take(sample, t, false);
    }
    cutter.look();
    EXPECT_LT(worst_difference_mm(*stock, *wanted), 2e-5) << applied_mm;
    EXPECT_EQ(cutter.facts().off_path, 0U);
    int told = 0;
    for (const Finding& finding : log.kept()) told += finding.id == FindingId::kToolLength ? 1 : 0;
    EXPECT_EQ(told, off_mm != 0 ? 1 : 0) << applied_mm;
  }
}

}  // namespace
}  // namespace kerf
