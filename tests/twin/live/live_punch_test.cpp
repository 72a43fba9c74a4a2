// Sheets under a punch that is watched, and what the look-ahead says of sheets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "tests/twin/live/live_shop.h"
#include "tests/twin/process/punch_shop.h"
#include "tests/twin/process/stages.h"
#include "tests/twin/process/torch_shop.h"
#include "twin/live/live_cutter.h"
#include "twin/process/punch/punch_plan.h"
#include "twin/process/torch/torch_plan.h"

namespace kerf {
namespace {

using test::sheet_200;
using test::square;
using test::torch_of;
using test::torch_program;
using test::turret;

using Ids = std::vector<std::string>;

/// Holes, a nibbled row and circle, slits that turn; punched by M3 with M5 behind it.
MotionList panel() {
  MotionList program;
  program.at({10, 10, 5}).tool(1).feed_rate(3000);
  const auto hit = [&](double x, double y) {
    program.traverse({x, y, 5}).spindle(true).signal().spindle(false).signal();
  };
  hit(30, 30);
  hit(60, 30);
  program.tool(2);
  hit(90, 30);
  hit(90, 60);
  program.tool(1).traverse({120, 30, 5}).spindle(true).signal();
  program.feed({160, 30, 5}).spindle(false).signal();
  program.traverse({170, 70, 5}).spindle(true).signal();
  program.arc({170, 70, 5}, {155, 70, 5}, {0, 0, 1}, 2 * kPi).spindle(false).signal();
  program.tool(3);
  hit(40, 70);
  program.traverse({40, 80, 5});
  program.last().to_abc_deg = {0, 0, 90};
  program.turned({0, 0, 90});
  program.traverse({80, 80, 5}).spindle(true).signal().spindle(false).signal();
  program.traverse({10, 10, 5});
  return program;
}

/// A dry run.
struct Dry {
  explicit Dry(const MotionList& program, const TurretPointer& press)
      : sheet(sheet_200()),
        resolver({}, stock_model(StockKind::kSheet).can_cut),
        stage(*sheet, resolver, log, TimelineOptions{}, *punch_process(press)) {
    stage.take(program.list());
    stage.finish();
  }
  std::unique_ptr<Sheet> sheet;
  FindingLog log;
  ToolResolver resolver;
  CutStage stage;
};

Ids ids_of(const FindingLog& log) {
  Ids out;
  for (const Finding& finding : log.kept()) out.emplace_back(to_string(finding.id));
  return out;
}

/// A press, or a torch table, that is watched.
class SheetWatch {
 public:
  using Edit = std::function<void(AxisSample&, const TimedMotion&)>;

  SheetWatch(const MotionList* program, TurretPointer press, double guard_s = 0,
             GapPolicy gap = GapPolicy::kMark, JoinedLate joined_late = JoinedLate::kCut)
      : sheet_(sheet_200()) {
    LiveCutOptions options;
    options.frame.tool_length = ToolLengthFrom::kNone;
    options.wait_for_program = true;
    options.guard_s = guard_s;
    options.gap = gap;
    options.joined_late = joined_late;
    options.process = press ? punch_process(std::move(press)) : torch_process({});
    std::unique_ptr<Program> listed;
    if (program) listed = std::make_unique<ListedProgram>(program->list());
    cutter_ =
        std::make_unique<LiveCutter>(*sheet_, torch_of("kerf:2"), log, options, std::move(listed));
  }
  void take(const AxisSample& sample, double t_s) {
    cutter_->take(sample, t_s, false);
    cutter_->look();
    for (AheadWarning& warning : cutter_->take_warnings()) {
      warnings.push_back({std::move(warning), t_s});
    }
  }
  void run(const RunningMachine& machine, double rate_hz, const Edit& edit = {}) {
    const double end_s = machine.duration_s();
    for (int i = 0; i <= static_cast<int>(end_s * rate_hz) + 1; ++i) {
      const double t = std::min(end_s, i / rate_hz);
      AxisSample sample = machine.sample(t);
      const Motion& m = machine.at(t).motion;
      const double share = machine.at(t).step.way_at(t);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        sample.set(3 + axis,
                   m.from_abc_deg[axis] + share * (m.to_abc_deg[axis] - m.from_abc_deg[axis]));
      }
      if (edit) edit(sample, machine.at(t));
      take(sample, i / rate_hz);
    }
    cutter_->finish();
  }
  const Sheet& sheet() const { return *sheet_; }
  double punched_mm2() const { return 20000 - sheet_->remaining_mm2(); }
  LiveCutter& cutter() { return *cutter_; }
  PunchTotals totals() const { return test::punch_of(cutter_->stage()).totals(); }

  struct Warned {
    AheadWarning warning;
    double at_s = 0;
  };
  FindingLog log;
  std::vector<Warned> warnings;

 private:
  std::unique_ptr<Sheet> sheet_;
  std::unique_ptr<LiveCutter> cutter_;
};

TEST(LivePunch, AlongTheProgramTheSheetIsThatOfTheDryRunBitForBit) {
  const MotionList program = panel();
  const auto press = turret("m3", 4);
  const Dry dry(program, press);
  ASSERT_EQ(ids_of(dry.log), Ids{});
  const RunningMachine machine(program.list());
  for (const double rate_hz : {7.0, 50.0, 400.0}) {
    SheetWatch watch(&program, press);
    watch.run(machine, rate_hz);
    EXPECT_EQ(watch.sheet().digest(), dry.sheet->digest()) << rate_hz;
    EXPECT_EQ(ids_of(watch.log), Ids{}) << rate_hz;
    EXPECT_EQ(watch.totals().hits, test::punch_of(dry.stage).totals().hits);
    EXPECT_NEAR(watch.totals().nibbled_mm, test::punch_of(dry.stage).totals().nibbled_mm, 1e-9);
    ASSERT_EQ(watch.cutter().stage().process().freed().size(), 1U) << "the slug of the circle";
    EXPECT_EQ(watch.cutter().stage().process().freed()[0].source,
              dry.stage.process().freed()[0].source);
  }
}

/// Never ahead of the machine: while it stands at a place the stroke has not been, and while it is
/// on a nibbled move none of that.
TEST(LivePunch, StrokesComeWhenTheMachineHasBeenThere) {
  const MotionList program = panel();
  const RunningMachine machine(program.list());
  SheetWatch watch(&program, turret("m3", 4));
  std::map<std::uint32_t, std::pair<int, double>> rows;  // samples on them, and what was punched
  watch.run(machine, 100, [&](AxisSample&, const TimedMotion& at) {
    const Motion& m = at.motion;
    if (m.source.line == 2 || m.source.line == 3) {
      EXPECT_EQ(watch.punched_mm2(), 0) << "on its way to the first hole, and there";
    }
    if (!is_feed(m)) return;
    auto& [samples, punched_mm2] = rows[m.source.line];
    // The first two bring what was struck before the move.
    if (samples == 2) punched_mm2 = watch.punched_mm2();
    if (samples > 2) {
      EXPECT_EQ(watch.punched_mm2(), punched_mm2);
    }
    ++samples;
  });
  EXPECT_EQ(rows.size(), 2U);
  EXPECT_GT(watch.totals().hits, 30U);
}

/// Seen from its middle on, or up to there, a row has the strokes that were seen.
TEST(LivePunch, OfARowWhatIsSeenIsStruck) {
  MotionList program;
  program.at({10, 10, 5}).tool(1).feed_rate(3000).traverse({30, 50, 5}).spindle(true).signal();
  program.feed({110, 50, 5}).spindle(false).signal().traverse({10, 10, 5});
  const RunningMachine machine(program.list());
  const auto punched = [&](double from_x, double until_x, JoinedLate joined_late) {
    SheetWatch watch(&program, turret("m3", 8), 0, GapPolicy::kMark, joined_late);
    for (double t = 0; t <= machine.duration_s(); t += 0.01) {
      const double x = machine.tip(t).x;
      const bool feeds = machine.at(t).motion.kind == MotionKind::kFeed;
      if (feeds && x >= from_x && x <= until_x) watch.take(machine.sample(t), t);
    }
    watch.cutter().finish();
    std::vector<bool> out;
    for (double x = 30; x <= 110; x += 8) out.push_back(!watch.sheet().has_material({x, 50}));
    return out;
  };
  // Strokes at 30, 38, .. 110; the first one is M3's.
  const std::vector<bool> middle = punched(51, 75, JoinedLate::kKeep);
  const std::vector<bool> until = punched(51, 75, JoinedLate::kCut);
  for (std::size_t i = 0; i < middle.size(); ++i) {
    const double x = 30 + 8 * static_cast<double>(i);
    EXPECT_EQ(middle[i], x > 52 && x < 75) << x;
    EXPECT_EQ(until[i], x < 75) << x;
  }
}

TEST(LivePunch, FindingsAreThoseOfTheDryRun) {
  auto press = turret("m101");
  press->clamps.push_back({{60, -40}, {80, 20}, 0});
  press->regrips.push_back({.user_code = 120, .line = 0, .shift_mm = {60, 0}});
  MotionList program;
  program.at({10, 10, 5}).tool(1).traverse({70, 15, 5}).signal(101);
  program.traverse({70, 60, 5}).signal(120).traverse({130, 15, 5}).signal(101);
  program.tool(9).traverse({100, 60, 5}).signal(101);
  program.tool(1).traverse({-30, 60, 5}).signal(101).traverse({70, 15, 5}).signal(101);
  program.traverse({10, 10, 5});
  const Dry dry(program, press);
  ASSERT_EQ(ids_of(dry.log),
            (Ids{"hit-on-clamp", "hit-on-clamp", "station-empty", "hit-off-sheet", "hit-in-air"}));
  const RunningMachine machine(program.list());
  SheetWatch watch(&program, press);
  watch.run(machine, 50);
  ASSERT_EQ(ids_of(watch.log), ids_of(dry.log));
  for (std::size_t i = 0; i < dry.log.kept().size(); ++i) {
    EXPECT_EQ(watch.log.kept()[i].source, dry.log.kept()[i].source);
    EXPECT_EQ(watch.log.kept()[i].text, dry.log.kept()[i].text);
  }
  EXPECT_EQ(watch.totals().regrips, 1U);
}

TEST(LivePunch, TheMachinesToolIsTheOneThatPunches) {
  MotionList program;
  program.at({10, 10, 5}).tool(1).traverse({50, 50, 5}).signal(101).traverse({80, 50, 5});
  program.signal(101).tool(4).traverse({110, 50, 5}).signal(101).traverse({10, 10, 5});
  const RunningMachine machine(program.list());
  SheetWatch watch(&program, turret("m101"));
  watch.run(machine, 50, [](AxisSample& sample, const TimedMotion&) {
    if (sample.tool == 1) sample.tool = 2;
  });
  EXPECT_NEAR(watch.punched_mm2(), 100 + 100 + kPi * 4, 0.02);
  EXPECT_EQ(ids_of(watch.log), Ids{"tool-mismatch"});
}

/// What the machine did while nobody looked is not known.
TEST(LivePunch, AcrossAGapNothingIsStruckUnlessItIsMeant) {
  MotionList program;
  program.at({10, 50, 5}).tool(1);
  for (const double x : {40.0, 70.0, 100.0, 130.0}) program.traverse({x, 50, 5}).signal(101);
  program.traverse({10, 50, 5});
  const RunningMachine machine(program.list());
  for (const GapPolicy gap : {GapPolicy::kMark, GapPolicy::kCut}) {
    SheetWatch watch(&program, turret("m101"), 0, gap);
    double late_s = 0;
    for (double t = 0; t < machine.duration_s() + 0.03; t += 0.01) {
      const double x = machine.tip(t).x;
      const bool unseen = machine.at(t).motion.source.line >= 4 &&
                          machine.at(t).motion.source.line <= 8 && x > 80 && x < 110;
      if (unseen) late_s = 5;
      if (!unseen) watch.take(machine.sample(std::min(t, machine.duration_s())), t + late_s);
    }
    watch.cutter().finish();
    EXPECT_EQ(ids_of(watch.log), Ids{"source-gap"});
    EXPECT_EQ(watch.sheet().has_material({100, 50}), gap == GapPolicy::kMark);
    EXPECT_FALSE(watch.sheet().has_material({70, 50}));
    EXPECT_FALSE(watch.sheet().has_material({130, 50}));
  }
}

/// As LinuxCNC has it where it stands for a stroke: M3, a pause, M5.
MotionList standing_hits() {
  MotionList program;
  program.at({10, 10, 5}).tool(1).feed_rate(3000);
  for (const double x : {40.0, 80.0}) {
    program.traverse({x, 40, 5}).spindle(true).dwell(0.1).spindle(false).dwell(0.05);
  }
  program.traverse({120, 40, 5}).spindle(true).dwell(0.1).feed({160, 40, 5}).dwell(0.1);
  program.spindle(false).dwell(0.1).traverse({10, 10, 5});
  return program;
}

void tell_spindle(AxisSample& sample, const TimedMotion& at) {
  sample.spindle_rpm = at.motion.spindle == SpindleState::kStopped ? 0 : 1000;
}

TEST(LivePunch, WithoutAProgramTheSpindleIsTheTrigger) {
  const MotionList program = standing_hits();
  const RunningMachine machine(program.list());
  const auto press = turret("m3", 4);
  const Dry dry(program, press);
  SheetWatch watch(nullptr, press);
  watch.run(machine, 200, tell_spindle);
  EXPECT_EQ(watch.totals().hits, test::punch_of(dry.stage).totals().hits);
  EXPECT_EQ(watch.totals().hits, 2U + 11);
  // Places of samples on a line: what is between strokes is not as long to the last digit.
  EXPECT_NEAR(watch.punched_mm2(), 20000 - dry.sheet->remaining_mm2(), 1);
  EXPECT_EQ(ids_of(watch.log), Ids{});
}

TEST(LivePunch, WithoutAPitchAMachineThatMovesDragsThePunch) {
  const MotionList program = standing_hits();
  const RunningMachine machine(program.list());
  SheetWatch watch(nullptr, turret("m3"));
  watch.run(machine, 100, tell_spindle);
  EXPECT_EQ(watch.totals().hits, 3U);
  EXPECT_FALSE(watch.log.kept().empty());
  EXPECT_EQ(ids_of(watch.log).front(), "punch-down");
}

TEST(LivePunch, ATriggerOfTheSourceStandsForWhateverTheTurretNames) {
  const MotionList program = standing_hits();
  const RunningMachine machine(program.list());
  for (const char* const trigger : {"m101", "m62:3", "m7+feed", "g81"}) {
    SheetWatch watch(nullptr, turret(trigger));
    watch.run(machine, 100, [](AxisSample& sample, const TimedMotion& at) {
      const bool dwells = at.motion.kind == MotionKind::kDwell;
      sample.trigger = dwells && at.motion.spindle != SpindleState::kStopped ? 1 : 0;
    });
    EXPECT_FALSE(watch.sheet().has_material({40, 40})) << trigger;
    EXPECT_FALSE(watch.sheet().has_material({80, 40})) << trigger;
    EXPECT_FALSE(watch.sheet().has_material({120, 40})) << trigger;
  }
}

TEST(LivePunch, AtTheEndsOfMovesIfThatIsMeant) {
  MotionList program;
  program.at({10, 10, 5}).tool(2).traverse({30, 40, 5}).spindle(true).dwell(0.1);
  for (const double x : {60.0, 90.0, 120.0}) program.traverse({x, 40, 5}).dwell(0.1);
  program.spindle(false).dwell(0.1).traverse({150, 40, 5}).dwell(0.1);
  const RunningMachine machine(program.list());
  auto press = turret("m3");
  press->strikes_at_ends = true;
  SheetWatch watch(nullptr, press);
  watch.run(machine, 100, tell_spindle);
  EXPECT_EQ(watch.totals().hits, 3U);
  EXPECT_TRUE(watch.sheet().has_material({30, 40}));
  EXPECT_FALSE(watch.sheet().has_material({120, 40}));
  EXPECT_NEAR(watch.punched_mm2(), 300, 1e-3);
}

TEST(LivePunch, DrillingCyclesAreSeenByZ) {
  MotionList program;
  program.at({10, 10, 5}).tool(2).feed_rate(600);
  for (const double x : {50.0, 90.0}) {
    program.traverse({x, 50, 5}).traverse({x, 50, 2}).feed({x, 50, -1}).traverse({x, 50, 5});
  }
  program.traverse({10, 10, 5});
  const RunningMachine machine(program.list());
  for (const char* const trigger : {"g81", "z<0"}) {
    SheetWatch watch(nullptr, turret(trigger));
    watch.run(machine, 100);
    EXPECT_EQ(watch.totals().hits, 2U) << trigger;
    EXPECT_NEAR(watch.punched_mm2(), 200, 1e-3) << trigger;
    EXPECT_EQ(ids_of(watch.log), Ids{}) << trigger;
  }
}

TEST(LivePunch, WhereNothingTellsOfTheTriggerNothingIsPunchedAndItIsTold) {
  const MotionList program = standing_hits();
  const RunningMachine machine(program.list());
  SheetWatch silent(nullptr, turret("m3"));
  silent.run(machine, 100);
  EXPECT_EQ(silent.punched_mm2(), 0);
  ASSERT_EQ(ids_of(silent.log), Ids{"no-hit"});
  EXPECT_EQ(
      silent.log.kept()[0].text,
      "nothing tells when the punch strikes: the source has neither a spindle speed nor a "
      "trigger (punch.trigger in press.yaml), and no program is followed (--program); nothing is "
      "punched until it does");
  SheetWatch output(nullptr, turret("m62:1"));
  output.run(machine, 100, tell_spindle);
  EXPECT_EQ(ids_of(output.log), Ids{"no-hit"});
}

// The look-ahead.

Ids warned_of(const SheetWatch& watch) {
  Ids out;
  for (const SheetWatch::Warned& one : watch.warnings) {
    out.emplace_back(to_string(one.warning.finding.id));
  }
  return out;
}

/// When a line of the program begins.
double time_of(const RunningMachine& machine, std::uint32_t line) {
  for (const TimedMotion& m : machine.list()) {
    if (m.motion.source.line == line) return m.step.start_s;
  }
  return -1;
}

TEST(SheetGuard, ClampsAndEmptyStationsAreToldBeforeThePunchIsThere) {
  auto press = turret("m101");
  press->clamps.push_back({{60, -40}, {80, 20}, 0});
  MotionList program;
  program.at({10, 10, 5}).tool(1).feed_rate(1200).traverse({30, 60, 5}).signal(101);
  program.feed({70, 60, 5}).feed({70, 15, 5}).signal(101);  // line 6
  program.tool(9).feed({100, 60, 5}).signal(101);           // line 9
  program.tool(1).feed({-30, 60, 5}).signal(101).traverse({10, 10, 5});
  const RunningMachine machine(program.list());
  SheetWatch watch(&program, press, 1.5);
  watch.run(machine, 50);
  EXPECT_EQ(warned_of(watch), (Ids{"hit-on-clamp", "station-empty", "hit-off-sheet"}));
  EXPECT_EQ(warned_of(watch), ids_of(watch.log)) << "and it happens";
  for (const SheetWatch::Warned& one : watch.warnings) {
    const double happens_s = time_of(machine, one.warning.finding.source.line);
    EXPECT_NEAR(*one.warning.finding.time_s, happens_s, 0.05);
    EXPECT_GT(happens_s - one.at_s, 1.4) << to_string(one.warning.finding.id);
  }
}

TEST(SheetGuard, PiercingAPartAndCrossingOneAreToldBefore) {
  MotionList program = torch_program();
  program.feed_rate(1500);
  square(program, {40, 20}, 30);
  program.traverse({100, 80, 1}).dwell(1);
  program.traverse({50, 30, 1}).spindle(true).feed({60, 40, 1}).spindle(false);
  program.traverse({5, 5, 20});
  const RunningMachine machine(program.list());
  SheetWatch watch(&program, nullptr, 2);
  watch.run(machine, 50);
  const Ids ids = warned_of(watch);
  EXPECT_EQ(std::count(ids.begin(), ids.end(), "crosses-part"), 1) << "on its way there";
  EXPECT_EQ(std::count(ids.begin(), ids.end(), "pierce-in-part"), 1);
  for (const SheetWatch::Warned& one : watch.warnings) {
    EXPECT_GT(time_of(machine, one.warning.finding.source.line) - one.at_s, 0.9)
        << to_string(one.warning.finding.id);
  }
}

/// The guard begins anew beside the path: what was free before is free still.
TEST(SheetGuard, PartsThatWereFreeBeforeAreKnownToIt) {
  MotionList program = torch_program();
  program.feed_rate(1500);
  square(program, {40, 20}, 30);
  program.traverse({100, 80, 20}).dwell(1.5).traverse({110, 80, 20}).dwell(1.5);
  program.traverse({50, 30, 1}).spindle(true).feed({60, 40, 1}).spindle(false);
  program.traverse({5, 5, 20});
  const RunningMachine machine(program.list());
  SheetWatch watch(&program, nullptr, 1);
  bool cut_free = false;
  for (double t = 0; t < machine.duration_s(); t += 0.02) {
    AxisSample sample = machine.sample(t);
    // Jogged away over the sheet with the spindle on, and back.
    const Motion& m = machine.at(t).motion;
    const bool jogs = m.kind == MotionKind::kDwell && machine.tip(t).x == 100 &&
                      t - machine.at(t).step.start_s < 0.5;
    if (jogs) {
      sample.set(1, 80 + 20 * std::sin((t - machine.at(t).step.start_s) * 2 * kPi));
      sample.spindle_rpm = 1000;
    }
    watch.take(sample, t);
    cut_free = cut_free || !watch.cutter().stage().process().freed().empty();
  }
  EXPECT_TRUE(cut_free);
  const Ids ids = warned_of(watch);
  EXPECT_EQ(std::count(ids.begin(), ids.end(), "pierce-in-part"), 1);
}

}  // namespace
}  // namespace kerf
