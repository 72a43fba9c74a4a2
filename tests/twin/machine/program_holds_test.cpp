#include "twin/machine/program_holds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/twin/process/motions.h"
#include "tests/twin/process/punch_shop.h"
#include "twin/machine/timeline.h"
#include "twin/process/punch/punch_plan.h"
#include "twin/process/torch/torch_plan.h"

namespace kerf {
namespace {

/// The clock adds up thousands of times.
constexpr double kClose_s = 1e-9;

class Steps : private StepSink {
 public:
  Steps(const MotionList& program, const MakeHolds& holds,
        const std::vector<TorchMaterial>& materials = {}) {
    TimelineOptions options;
    options.holds = holds;
    Timeline timeline(options, *this);
    timeline.set_materials(materials);
    for (const Motion& m : program.list()) timeline.push(m);
    timeline.finish();
    totals = timeline.totals();
    end_s = timeline.clock_s();
    model = timeline.time_model();
  }
  const TimedStep& at(std::size_t i) const { return list.at(i); }
  /// From one step's end to the next one's beginning.
  double gap_s(std::size_t i) const {
    return list.at(i + 1).start_s - list.at(i).start_s - list.at(i).duration_s;
  }
  std::vector<TimedStep> list;
  MotionTotals totals;
  double end_s = 0;
  std::string model;

 private:
  void step(const Motion&, const TimedStep& timed, std::span<const PathPiece>) override {
    list.push_back(timed);
  }
};

MakeHolds press(const std::shared_ptr<Turret>& turret) { return punch_process(turret)->holds(); }

MotionList start(int tool) {
  MotionList program;
  program.at({0, 0, 5}).tool(tool);
  return program;
}

TEST(ProgramHolds, AStrokeOfASignalIsItsOwnTime) {
  MotionList program = start(1);
  program.traverse({50, 50, 5}).spindle(true).signal().spindle(false).signal();
  program.traverse({80, 50, 5}).signal(101);
  auto with = test::turret("m3");
  with->times.stroke_s = 0.25;
  const Steps none(program, {}), plain(program, press(test::turret("m3"))),
      timed(program, press(with));
  EXPECT_EQ(plain.end_s, none.end_s) << "where no times are given, none";
  EXPECT_NEAR(timed.end_s, none.end_s + 0.25, kClose_s);
  EXPECT_NEAR(timed.at(2).duration_s, 0.25, kClose_s);
  EXPECT_EQ(timed.at(3).duration_s, 0) << "M5";
  EXPECT_FALSE(none.totals.held);
  ASSERT_TRUE(timed.totals.held);
  EXPECT_NEAR(timed.totals.held->strokes_s, 0.25, kClose_s);
  EXPECT_NEAR(timed.totals.duration_s, none.totals.duration_s + 0.25, kClose_s);
  EXPECT_NE(plain.model.find("; strokes, turret and re-gripping no time (press.yaml has no times)"),
            std::string::npos)
      << plain.model;
  EXPECT_NE(timed.model.find("; a stroke 0.25 s, the turret 0 s a change and 0 s a place"),
            std::string::npos)
      << timed.model;
}

TEST(ProgramHolds, StrokesAtTheEndsOfMovesStandBehindThem) {
  MotionList program = start(2);
  program.traverse({50, 50, 5}).traverse({50, 50, 2}).feed({50, 50, -1}).traverse({50, 50, 2});
  auto cycle = test::turret("g81");
  cycle->times.stroke_s = 0.5;
  const Steps none(program, {}), timed(program, press(cycle));
  // What was blended into the move up comes to a stand now.
  EXPECT_GT(timed.end_s, none.end_s + 0.5);
  EXPECT_NEAR(timed.end_s, none.end_s + 0.5, 0.05);
  EXPECT_NEAR(timed.at(3).duration_s, none.at(3).duration_s, 0.05) << "the plunge itself";
  EXPECT_NEAR(timed.gap_s(3), 0.5, kClose_s);
  // The last of all: nothing behind it shows the time, and it is there.
  MotionList last = start(2);
  last.traverse({50, 50, 2}).feed({50, 50, -1});
  const Steps without(last, {}), with(last, press(cycle));
  EXPECT_NEAR(with.end_s, without.end_s + 0.5, kClose_s);
  EXPECT_NEAR(with.totals.duration_s, without.totals.duration_s + 0.5, kClose_s);
}

TEST(ProgramHolds, ASynchronousOutputStrikesBeforeItsMove) {
  MotionList program = start(2);
  program.traverse({50, 50, 5}).output(0, true).traverse({90, 50, 5}).output(0, false);
  program.traverse({130, 50, 5});
  auto sync = test::turret("m62:0");
  sync->times.stroke_s = 0.5;
  const Steps none(program, {}), timed(program, press(sync));
  EXPECT_NEAR(timed.gap_s(1), none.gap_s(1) + 0.5, 0.02) << "it stands, and starts again";
  EXPECT_NEAR(timed.at(2).held_before_s, 0.5, kClose_s);
}

/// A way of 40 mm, from stand to stand each time.
TEST(ProgramHolds, NibblingStandsAtEveryStroke) {
  const auto row = [](double pitch_mm) {
    MotionList program = start(1);
    program.feed_rate(6000).traverse({30, 50, 5}).spindle(true).signal();
    program.feed({30 + pitch_mm, 50, 5});
    return program;
  };
  MotionList program = row(40);
  auto nibbles = test::turret("m3", 4);
  nibbles->times.stroke_s = 0.1;
  const Steps timed(program, press(nibbles));
  const Steps step(row(4), press(test::turret("m3", 4)));
  const double step_s = step.at(3).duration_s;
  EXPECT_NEAR(timed.at(3).duration_s, 10 * (step_s + 0.1), 10 * 0.005);
  EXPECT_NEAR(timed.totals.held->strokes_s, 11 * 0.1, kClose_s) << "with that of M3";
  EXPECT_EQ(timed.list.size(), program.list().size()) << "one step a motion";
  EXPECT_EQ(timed.at(3).length_mm, 40);
  EXPECT_EQ(timed.at(3).programmed_mm_per_min, 6000);
  // No faster than its table; slower where the way takes longer.
  nibbles->times.period_by_pitch_s = {{1, 0.1}, {7, 0.7}};
  const Steps slow(program, press(nibbles));
  EXPECT_NEAR(slow.at(3).duration_s, 10 * 0.4, 0.01) << "4 mm: halfway between";
  nibbles->times.period_by_pitch_s = {{1, 0.001}};
  EXPECT_NEAR(Steps(program, press(nibbles)).at(3).duration_s, timed.at(3).duration_s, kClose_s);
  // An arc, and a rest of a step at its end.
  MotionList round = start(1);
  round.feed_rate(6000).traverse({130, 50, 5}).spindle(true).signal();
  round.arc({70, 50, 5}, {100, 50, 5}, {0, 0, 1}, kPi);
  nibbles->times.period_by_pitch_s = {{1, 1.0}};
  EXPECT_NEAR(Steps(round, press(nibbles)).at(3).duration_s, std::ceil(kPi * 30 / 4), 0.05);
}

TEST(ProgramHolds, PeriodsByPitch) {
  PunchTimes times;
  EXPECT_EQ(times.period_s(3), 0);
  times.period_by_pitch_s = {{2, 0.1}, {10, 0.3}};
  EXPECT_EQ(times.period_s(0.5), 0.1);
  EXPECT_EQ(times.period_s(2), 0.1);
  EXPECT_NEAR(times.period_s(4), 0.15, 1e-15);
  EXPECT_EQ(times.period_s(10), 0.3);
  EXPECT_EQ(times.period_s(50), 0.3);
}

TEST(ProgramHolds, TheTurretGoesTheShorterWay) {
  PunchTimes times;
  times.step_s = 0.1;
  times.lock_s = 1;
  EXPECT_EQ(times.change_s(3, 3), 0);
  EXPECT_EQ(times.change_s(0, 3), 1) << "from nobody knows where";
  EXPECT_NEAR(times.change_s(3, 20), 2.7, 1e-12);
  times.places = 22;
  EXPECT_NEAR(times.change_s(3, 20), 1.5, 1e-12);
  EXPECT_NEAR(times.change_s(20, 3), 1.5, 1e-12);
  EXPECT_NEAR(times.change_s(2, 13), 2.1, 1e-12);
}

TEST(ProgramHolds, ChangesAndRegripping) {
  MotionList program = start(1);
  program.traverse({50, 50, 5}).tool(4).traverse({80, 50, 5}).tool(4).signal(120);
  program.traverse({90, 50, 5}).traverse({95, 50, 5});
  auto times = test::turret("m101");
  times->times.step_s = 0.5;
  times->times.lock_s = 1;
  times->times.regrip_s = 6;
  times->regrips = {{.user_code = 120, .line = 0, .shift_mm = {30, 0}},
                    {.user_code = 0, .line = 8, .shift_mm = {-30, 0}}};
  const Steps none(program, {}), timed(program, press(times));
  EXPECT_NEAR(timed.totals.held->turret_s, 1 + 2.5, kClose_s) << "T4 again changes nothing";
  EXPECT_NEAR(timed.totals.held->regrip_s, 12, kClose_s);
  EXPECT_NEAR(timed.at(2).duration_s, none.at(2).duration_s + 2.5, 0.11) << "I/O looks each 0.1 s";
  EXPECT_NEAR(timed.at(5).duration_s, 6, kClose_s);
  EXPECT_NEAR(timed.gap_s(6), 6, 0.02);
}

TEST(ProgramHolds, TorchesWaitForThePierce) {
  std::vector<TorchMaterial> materials(2);
  materials[0].pierce_delay_s = 0.5;
  materials[0].pause_at_end_s = 0.25;
  materials[1].pierce_delay_s = 2;
  BeamSettings beam;
  beam.trigger = std::move(*BeamTrigger::parse("plasmac"));
  beam.is_qtplasmac = true;
  const MakeHolds torch = torch_process(beam)->holds();
  MotionList program;
  program.at({0, 0, 1}).tool(1).traverse({10, 10, 1});
  program.spindle(true).feed({20, 10, 1}).feed({20, 20, 1}).spindle(false).traverse({0, 0, 1});
  const Steps none(program, {}), timed(program, torch, materials);
  EXPECT_NEAR(timed.end_s, none.end_s + 0.75, kClose_s);
  EXPECT_NEAR(timed.at(2).held_before_s, 0.5, kClose_s) << "before the first move";
  EXPECT_EQ(timed.at(3).held_before_s, 0);
  EXPECT_NEAR(timed.at(4).held_before_s, 0.25, kClose_s) << "M5";
  EXPECT_NEAR(timed.totals.held->pierces_s, 0.5, kClose_s);
  EXPECT_NEAR(timed.totals.held->pauses_s, 0.25, kClose_s);
  // A dwell goes on while the torch pierces.
  MotionList dwells;
  dwells.at({0, 0, 1}).tool(1).traverse({10, 10, 1}).spindle(true).dwell(0.3).feed({20, 10, 1});
  EXPECT_NEAR(Steps(dwells, torch, materials).totals.held->pierces_s, 0.2, kClose_s);
  // Held off by its output the arc has no pause; it pierces again with the next cut.
  MotionList off;
  off.at({0, 0, 1}).tool(1).traverse({10, 10, 1}).spindle(true).feed({20, 10, 1});
  off.output(3, true).feed({24, 10, 1}).output(3, false).spindle(false).traverse({0, 0, 1});
  const Steps held(off, torch, materials);
  EXPECT_NEAR(held.totals.held->pierces_s, 0.5, kClose_s);
  EXPECT_EQ(held.totals.held->pauses_s, 0);
  EXPECT_EQ(Steps(program, torch).totals.held->sum_s(), 0) << "no materials";
}

}  // namespace
}  // namespace kerf
