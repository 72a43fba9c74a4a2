// Programs that end, are aborted and begin again, and others that only look so.
#include "twin/live/live_shift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/twin/live/live_shop.h"
#include "tests/twin/process/stages.h"
#include "tests/twin/process/torch_shop.h"
#include "twin/process/torch/torch_plan.h"

namespace kerf {
namespace {

std::unique_ptr<ZMap> block() {
  ZMapOptions options;
  options.blank = parse_blank("box:0,0,-10:40,40,0").value();
  options.cell_mm = 0.1;
  return std::move(ZMap::create(options).value());
}

const ToolSources& cutters() {
  static const ToolSources sources = [] {
    ToolSources out;
    out.arguments.push_back(std::move(parse_tool_argument("1=flat:4").value()));
    return out;
  }();
  return sources;
}

/// What programs leave of one block, one after the other.
double removed_by(const std::vector<std::vector<Motion>>& programs) {
  auto stock = block();
  ToolResolver resolver(cutters(), ZMap::can_cut);
  for (const std::vector<Motion>& program : programs) {
    FindingLog log;
    CutStage stage(*stock, resolver, log, TimelineOptions{});
    stage.take(program);
    stage.finish();
  }
  return stock->blank_mm3() - stock->remaining_mm3();
}

/// Two rounds of the same slots, in the same lines, with a stop between them.
MotionList slots(double y) {
  MotionList program;
  program.at({-5, y, 20}).tool(1).spindle(true).feed_rate(1800);
  for (int round = 0; round < 2; ++round) {
    const double z = -1.0 - round;
    program.traverse({-5, y, 5}).traverse({-5, y, z}).feed({30, y, z});
    program.feed({30, y + 3, z}).feed({-5, y + 3, z}).traverse({-5, y + 3, 5}).dwell(0.4);
  }
  program.traverse({-5, y, 20});
  return program;
}

/// With the lines of a loop: those of the second round are those of the first.
std::vector<Motion> looped(const MotionList& program) {
  std::vector<Motion> motions = program.list();
  for (Motion& m : motions) {
    if (m.source.line > 8 && m.source.line < motions.size()) m.source.line -= 7;
  }
  // From wherever the machine was.
  motions[1].start_known = false;
  return motions;
}

enum class Says { kState, kLine, kNothing };

/// A machine that is watched through a shift.
class Shift {
 public:
  Shift(std::vector<std::vector<Motion>> programs, Says says,
        OnProgramEnd on_end = OnProgramEnd::kKeep)
      : says_(says), programs_(std::move(programs)) {
    ShiftOptions options;
    options.cutting.frame.tool_length = ToolLengthFrom::kNone;
    options.cutting.wait_for_program = true;
    options.on_end = on_end;
    for (std::size_t i = 0; i < programs_.size(); ++i) {
      options.programs.push_back(
          {std::string(1, static_cast<char>('a' + i)), [this, i](const ProgramStart& start) {
             started_.push_back(start);
             return std::make_unique<ListedProgram>(programs_[i]);
           }});
    }
    options.cutting.reopen = [open = options.programs[0].open] { return open({}); };
    shift_ = std::make_unique<LiveShift>(block(), cutters(), log_, options,
                                         std::make_unique<ListedProgram>(programs_[0]));
    machines_.reserve(programs_.size());
    for (const auto& program : programs_) {
      std::vector<Motion> known = program;
      for (Motion& m : known) m.start_known = true;
      machines_.emplace_back(known);
    }
  }
  void see(const Vec3& tip, int line, ProgramState state, int tool = 1) {
    AxisSample sample;
    for (int i = 0; i < 3; ++i) sample.set(static_cast<std::size_t>(i), tip[i]);
    sample.tool = tool;
    if (says_ != Says::kNothing) sample.line = line;
    if (says_ == Says::kState) sample.program = state;
    shift_->take(sample, t_s_, false);
    shift_->look();
    const auto warnings = shift_->take_warnings();
    warnings_.insert(warnings_.end(), warnings.begin(), warnings.end());
    tip_ = tip;
    t_s_ += kPeriod_s;
  }
  void stand(double seconds, int tool = 1) {
    for (double t = 0; t < seconds; t += kPeriod_s) see(tip_, 0, ProgramState::kIdle, tool);
  }
  void jog_up(double z) { jog({tip_.x, tip_.y, z}); }
  void jog_up_as_line(double z, int line) { go({tip_.x, tip_.y, z}, line, ProgramState::kIdle); }
  /// By hand.
  void jog(const Vec3& to) { go(to, 0, ProgramState::kIdle); }
  /// Nobody looks, and then it is there.
  void blind(double seconds, const Vec3& then) {
    t_s_ += seconds;
    tip_ = then;
  }
  /// The program, between two times of its plan; it is driven to where it begins.
  void run(std::size_t program, double from_s = 0,
           double until_s = std::numeric_limits<double>::infinity()) {
    const RunningMachine& machine = machines_[program];
    // The first move, from wherever it is, is that of line 2.
    go(machine.tip(from_s), std::max(2, line_at(machine, from_s)), ProgramState::kRunning);
    const double end_s = std::min(until_s, machine.duration_s());
    for (double t = from_s; t < end_s; t += kPeriod_s) {
      const bool dwells = machine.at(t).motion.kind == MotionKind::kDwell;
      const int line = std::max(2, line_at(machine, t));
      see(machine.tip(t), dwells ? 0 : line, ProgramState::kRunning);
    }
    if (until_s >= machine.duration_s()) {
      see(machine.tip(end_s), line_at(machine, end_s), ProgramState::kRunning);
    }
    stand(0.3);
  }
  /// From its beginning, and not seen any more then.
  void run_unfinished(std::size_t program, double until_s) {
    const RunningMachine& machine = machines_[program];
    go(machine.tip(0), std::max(2, line_at(machine, 0)), ProgramState::kRunning);
    for (double t = 0; t < until_s; t += kPeriod_s) {
      const bool dwells = machine.at(t).motion.kind == MotionKind::kDwell;
      see(machine.tip(t), dwells ? 0 : std::max(2, line_at(machine, t)), ProgramState::kRunning);
    }
  }
  void finish() { shift_->finish(); }
  LiveShift& shift() { return *shift_; }
  const std::vector<LiveRun>& runs() const { return shift_->past(); }
  double duration_s(std::size_t program) const { return machines_[program].duration_s(); }
  const FindingLog& log() const { return log_; }
  /// Where the machine stood, of each time that a program was opened.
  const std::vector<ProgramStart>& started() const { return started_; }
  std::size_t warnings() const { return warnings_.size(); }
  std::string said() const {
    std::string text;
    for (const LiveRun& run : shift_->past()) {
      text += std::to_string(run.number) + " part " + std::to_string(run.part) + " " + run.program +
              " " + to_string(run.end) + " from line " + std::to_string(run.from_line) + " at " +
              std::to_string(run.begin_s) + "\n";
    }
    for (const Finding& finding : log_.kept()) text += message_of(finding) + "\n";
    return text;
  }

 private:
  static constexpr double kPeriod_s = 0.01;
  static int line_at(const RunningMachine& machine, double t_s) {
    return static_cast<int>(std::max(1U, machine.at(t_s).motion.source.line));
  }
  void go(const Vec3& to, int line, ProgramState state) {
    const Vec3 from = tip_;
    const int steps = static_cast<int>(glm::length(to - from) / 0.8);
    for (int i = 1; i <= steps; ++i) {
      see(from + (to - from) * (static_cast<double>(i) / steps), line, state);
    }
  }

  Says says_;
  std::vector<std::vector<Motion>> programs_;
  std::vector<RunningMachine> machines_;
  FindingLog log_;
  std::unique_ptr<LiveShift> shift_;
  std::vector<AheadWarning> warnings_;
  std::vector<ProgramStart> started_;
  Vec3 tip_{-30, -30, 60};
  double t_s_ = 0;
};

struct Wanted {
  std::size_t part;
  const char* program;
  RunEnd end;
};

void expect_runs(const Shift& shift, const std::vector<Wanted>& wanted) {
  ASSERT_EQ(shift.runs().size(), wanted.size()) << shift.said();
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const LiveRun& run = shift.runs()[i];
    EXPECT_EQ(run.part, wanted[i].part) << i << "\n" << shift.said();
    EXPECT_EQ(run.program, wanted[i].program) << i << "\n" << shift.said();
    EXPECT_EQ(run.end, wanted[i].end) << i << "\n" << shift.said();
  }
}

class EveryShift : public ::testing::TestWithParam<Says> {};

TEST_P(EveryShift, AfterAnAbortTheProgramIsFollowedFromItsBeginning) {
  const std::vector<Motion> program = looped(slots(10));
  Shift shift({program}, GetParam());
  shift.stand(0.5);
  shift.run(0, 0, 0.7 * shift.duration_s(0));
  shift.jog_up(12);
  shift.jog({15, 14, 12});
  shift.stand(1);
  shift.run(0);
  shift.finish();
  expect_runs(shift, {{1, "a", RunEnd::kAborted}, {1, "a", RunEnd::kFinished}});
  EXPECT_NEAR(shift.runs().back().part_removed_mm3, removed_by({program}), 0.05);
  // Where nothing tells of lines or programs, a machine that is jogged has left its path.
  EXPECT_EQ(shift.log().total(), GetParam() == Says::kNothing ? 1U : 0U) << shift.said();
  // All of the second run but the way to its beginning is that of the path.
  EXPECT_GT(shift.runs().back().facts.path_mm, 170) << shift.said();
}

TEST_P(EveryShift, ASecondRunIsOneOfItsOwnInTheSamePartOrTheNext) {
  const std::vector<Motion> program = looped(slots(10));
  for (const OnProgramEnd on_end : {OnProgramEnd::kKeep, OnProgramEnd::kNewBlank}) {
    Shift shift({program}, GetParam(), on_end);
    shift.stand(0.5);
    shift.run(0);
    shift.jog({-20, -20, 40});
    shift.run(0);
    shift.finish();
    const std::size_t part = on_end == OnProgramEnd::kKeep ? 1 : 2;
    expect_runs(shift, {{1, "a", RunEnd::kFinished}, {part, "a", RunEnd::kFinished}});
    for (const LiveRun& run : shift.runs()) {
      EXPECT_NEAR(run.part_removed_mm3, removed_by({program}), 0.05) << run.number;
    }
    EXPECT_NEAR(shift.runs()[0].removed_mm3, removed_by({program}), 0.05);
    EXPECT_NEAR(shift.runs()[1].removed_mm3, part == 1 ? 0 : removed_by({program}), 0.05);
    EXPECT_EQ(shift.log().total(), 0U) << shift.said();
    EXPECT_EQ(shift.warnings(), 0U);
  }
}

TEST(LiveShift, AnEndThatNobodySawIsOneWhereOnlyWaysHomeWereLeft) {
  const std::vector<Motion> program = looped(slots(10));
  // The last way home, from Z5 to Z20, and the dwell before it; then what feeds a slot before that.
  for (const double before_end_s : {0.2, 3.0}) {
    Shift shift({program}, Says::kLine, OnProgramEnd::kNewBlank);
    shift.stand(0.5);
    shift.run_unfinished(0, shift.duration_s(0) - before_end_s);
    shift.blind(1.8, {-30, -30, 60});
    shift.run(0);
    shift.finish();
    const bool whole = before_end_s < 1;
    expect_runs(shift, {{1, "a", whole ? RunEnd::kFinished : RunEnd::kAborted},
                        {whole ? 2U : 1U, "a", RunEnd::kFinished}});
  }
}

TEST_P(EveryShift, WhichOfSeveralProgramsItIsItsPathTells) {
  const std::vector<Motion> a = looped(slots(10));
  const std::vector<Motion> b = looped(slots(22));
  Shift shift({a, b}, GetParam(), OnProgramEnd::kNewBlank);
  shift.stand(0.5);
  shift.run(1);
  shift.jog({-20, -20, 40});
  shift.run(0, 0, 0.5 * shift.duration_s(0));
  shift.jog_up(40);
  shift.jog({0, -20, 40});
  shift.run(1);
  shift.finish();
  expect_runs(
      shift,
      {{1, "b", RunEnd::kFinished}, {2, "a", RunEnd::kAborted}, {2, "b", RunEnd::kFinished}});
  EXPECT_NEAR(shift.runs()[0].part_removed_mm3, removed_by({b}), 0.05);
  EXPECT_GT(shift.runs()[2].part_removed_mm3, removed_by({b}) + 50);
  EXPECT_EQ(shift.log().total(), GetParam() == Says::kNothing ? 1U : 0U) << shift.said();
}

TEST_P(EveryShift, ARunThatGoesOnIsNoOther) {
  // The same lines twice, a dwell between them, and an end that is the beginning.
  const std::vector<Motion> program = looped(slots(10));
  Shift shift({program}, GetParam());
  shift.stand(0.5);
  shift.run(0);
  shift.stand(5);
  shift.finish();
  expect_runs(shift, {{1, "a", RunEnd::kFinished}});
  EXPECT_EQ(shift.runs()[0].from_line, 3U);
  EXPECT_EQ(shift.log().total(), 0U) << shift.said();
}

INSTANTIATE_TEST_SUITE_P(Sources, EveryShift,
                         ::testing::Values(Says::kState, Says::kLine, Says::kNothing),
                         [](const auto& says) {
                           return says.param == Says::kState  ? "State"
                                  : says.param == Says::kLine ? "Line"
                                                              : "Nothing";
                         });

/// One square a run, in a new sheet each: what the last run cut is not what the first one did.
TEST(LiveShift, EachRunHasItsOwnSheet) {
  for (const OnProgramEnd on_end : {OnProgramEnd::kNewBlank, OnProgramEnd::kKeep}) {
    MotionList small = test::torch_program();
    test::square(small, {40, 20}, 20);
    small.traverse({0, 0, 20});
    MotionList large = test::torch_program();
    test::square(large, {120, 30}, 40);
    large.traverse({0, 0, 20});
    const std::vector<std::vector<Motion>> programs{{small.list().begin(), small.list().end()},
                                                    {large.list().begin(), large.list().end()}};
    ShiftOptions options;
    options.cutting.frame.tool_length = ToolLengthFrom::kNone;
    options.cutting.wait_for_program = true;
    options.cutting.process = torch_process({});
    options.on_end = on_end;
    for (std::size_t i = 0; i < programs.size(); ++i) {
      options.programs.push_back(
          {std::string(1, static_cast<char>('a' + i)), [&programs, i](const ProgramStart&) {
             return std::make_unique<ListedProgram>(programs[i]);
           }});
    }
    FindingLog log;
    const ToolSources torch = test::torch_of("kerf:2");
    LiveShift shift(test::sheet_200(), torch, log, options,
                    std::make_unique<ListedProgram>(programs[0]));
    double t_s = 0;
    for (const std::size_t i : {0U, 1U, 0U}) {
      std::vector<Motion> known = programs[i];
      for (Motion& m : known) m.start_known = true;
      const RunningMachine machine(known);
      for (double at_s = 0; at_s < machine.duration_s(); at_s += 0.01, t_s += 0.01) {
        AxisSample sample = machine.sample(at_s, true);
        sample.program = ProgramState::kRunning;
        shift.take(sample, t_s, false);
      }
      AxisSample end = machine.sample(machine.duration_s());
      end.line = 0;
      end.program = ProgramState::kIdle;
      for (int k = 0; k < 30; ++k, t_s += 0.01) shift.take(end, t_s, false);
    }
    shift.finish();
    ASSERT_EQ(shift.past().size(), 3U);
    const bool is_new = on_end == OnProgramEnd::kNewBlank;
    // A square of 20 within the kerf of 2 mm is 18 mm, one of 40 is 38; with their leads of 3 mm
    // the torch goes 4 x 20 + 3 and 4 x 40 + 3.
    const double wanted_mm[] = {83, 163, 83};
    const double wanted_mm2[] = {18.0 * 18, 38.0 * 38, 18.0 * 18};
    for (std::size_t i = 0; i < 3; ++i) {
      const LiveRun& run = shift.past()[i];
      ASSERT_TRUE(run.sheet) << i;
      EXPECT_NEAR(test::cuts_of(*run.sheet).cut_mm, wanted_mm[i], 0.5) << i;
      EXPECT_EQ(test::cuts_of(*run.sheet).pierces, 1U) << i;
      if (!is_new) continue;
      ASSERT_EQ(run.sheet->parts.size(), 1U) << i;
      EXPECT_NEAR(run.sheet->parts[0].area_mm2, wanted_mm2[i], 1) << i;
    }
    if (is_new) continue;
    EXPECT_EQ(shift.past()[1].sheet->parts.size(), 2U);
  }
}

TEST(LiveShift, APausedProgramThatGoesOnIsNoOther) {
  const std::vector<Motion> program = looped(slots(10));
  Shift shift({program}, Says::kState);
  shift.stand(0.5);
  const double half_s = 0.5 * shift.duration_s(0);
  const RunningMachine machine(slots(10).list());
  for (double t = 0; t < half_s; t += 0.01) {
    shift.see(machine.tip(t), static_cast<int>(machine.at(t).motion.source.line),
              ProgramState::kRunning);
  }
  for (int i = 0; i < 500; ++i) shift.see(machine.tip(half_s), 0, ProgramState::kPaused);
  for (double t = half_s; t < machine.duration_s(); t += 0.01) {
    shift.see(machine.tip(t), static_cast<int>(machine.at(t).motion.source.line),
              ProgramState::kRunning);
  }
  shift.finish();
  ASSERT_EQ(shift.runs().size(), 1U) << shift.said();
  EXPECT_EQ(shift.log().total(), 0U) << shift.said();
}

TEST(LiveShift, ARunFromALineCutsWhatComesFromThere) {
  const MotionList list = slots(10);
  std::vector<Motion> program = list.list();
  program[1].start_known = false;
  for (const Says says : {Says::kState, Says::kLine}) {
    Shift shift({program}, says);
    shift.stand(0.5);
    // Aborted in line 3; begun again at line 11, which is in the second round.
    shift.run(0, 0, 1.0);
    shift.jog_up(20);
    shift.jog({-5, 10, 20});
    const RunningMachine machine(list.list());
    double from_s = 0;
    for (const TimedMotion& m : machine.list()) {
      if (m.motion.source.line == 11) from_s = m.step.start_s;
    }
    shift.run(0, from_s);
    shift.finish();
    ASSERT_EQ(shift.runs().size(), 2U) << shift.said();
    EXPECT_EQ(shift.runs()[1].from_line, 11U) << shift.said();
    EXPECT_EQ(shift.runs()[1].end, RunEnd::kFinished) << shift.said();
    EXPECT_EQ(shift.log().total(), 0U) << shift.said();
  }
}

TEST(LiveShift, WhatIsDoneByHandBetweenProgramsIsCutAndNotOffThePath) {
  const std::vector<Motion> program = looped(slots(10));
  Shift shift({program}, Says::kState);
  shift.stand(0.5);
  shift.run(0);
  shift.jog({20, 35, 5});
  shift.jog({20, 35, -2});
  shift.jog({20, 35, 5});
  shift.finish();
  EXPECT_NEAR(shift.runs()[0].part_removed_mm3, removed_by({program}) + 2 * kPi * 4, 0.5);
  EXPECT_EQ(shift.log().total(), 0U) << shift.said();
}

TEST(LiveShift, ABlockByHandThatHasALineIsNotOffThePathAfterAnAbort) {
  // As LinuxCNC has it: a block by hand is of the line after the last that was read.
  const std::vector<Motion> program = looped(slots(10));
  Shift shift({program}, Says::kLine);
  shift.stand(0.5);
  shift.run(0, 0, 0.4 * shift.duration_s(0));
  shift.jog_up_as_line(20, static_cast<int>(program.back().source.line) + 2);
  shift.stand(0.5);
  shift.run(0);
  shift.finish();
  expect_runs(shift, {{1, "a", RunEnd::kAborted}, {1, "a", RunEnd::kFinished}});
  EXPECT_EQ(shift.log().total(), 0U) << shift.said();
}

TEST_P(EveryShift, AProgramIsReadFromWhereTheMachineStoodBeforeIt) {
  const std::vector<Motion> program = looped(slots(10));
  Shift shift({program}, GetParam());
  shift.stand(0.5);
  shift.jog({7, 35, 20});
  shift.stand(0.5);
  shift.run(0);
  shift.jog({8, 36, 20});
  shift.stand(0.5);
  shift.run(0);
  shift.finish();
  expect_runs(shift, {{1, "a", RunEnd::kFinished}, {1, "a", RunEnd::kFinished}});
  const auto opened_at = [&](double x, double y) {
    return std::any_of(shift.started().begin(), shift.started().end(), [&](const ProgramStart& at) {
      return at && std::abs((*at)[0] - x) < 0.02 && std::abs((*at)[1] - y) < 0.02 &&
             std::abs((*at)[2] - 20) < 0.02;
    });
  };
  EXPECT_TRUE(opened_at(7, 35));
  EXPECT_TRUE(opened_at(8, 36));
  EXPECT_EQ(shift.log().total(), 0U) << shift.said();
}

TEST(LiveShift, AMachineThatWasSwitchedOffInAProgramThreatensNothing) {
  const std::vector<Motion> program = looped(slots(10));
  Shift shift({program}, Says::kState);
  shift.stand(0.5);
  shift.run(0, 0, 0.4 * shift.duration_s(0));
  // It is there again, with no tool that it knows of.
  shift.stand(3, 0);
  shift.finish();
  EXPECT_EQ(shift.warnings(), 0U);
  EXPECT_EQ(shift.log().total(), 0U) << shift.said();
}

}  // namespace
}  // namespace kerf
