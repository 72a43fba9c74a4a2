// Sheets under a torch that is watched.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/twin/live/live_shop.h"
#include "tests/twin/process/stages.h"
#include "tests/twin/process/torch_shop.h"
#include "twin/live/live_cutter.h"
#include "twin/process/torch/torch_plan.h"

namespace kerf {
namespace {

using test::sheet_200;
using test::square;
using test::torch_of;
using test::torch_program;

constexpr double kUntold = std::numeric_limits<double>::quiet_NaN();

/// A disc of 30 mm with a hole of 12 mm, and two squares, one of them within what is left between.
MotionList plates() {
  MotionList program = torch_program();
  const auto disc = [&](Vec2 center, double radius, double lead_mm) {
    const Vec3 begin{center.x + radius, center.y, 1};
    program.traverse({begin.x + lead_mm, center.y, 1}).spindle(true).dwell(0.3).feed(begin);
    program.arc(begin, {center.x, center.y, 1}, {0, 0, 1}, lead_mm > 0 ? -2 * kPi : 2 * kPi);
    program.spindle(false);
  };
  disc({40, 50}, 6, -3);
  disc({40, 50}, 15, 3);
  square(program, {80, 20}, 40);
  square(program, {140, 60}, 25);
  program.traverse({0, 0, 20});
  return program;
}

/// A torch table that is watched, and the sheet that it leaves.
class TorchWatch {
 public:
  explicit TorchWatch(const MotionList* program, BeamSettings beam = {}) : sheet_(sheet_200()) {
    LiveCutOptions options;
    options.frame.tool_length = ToolLengthFrom::kNone;
    options.wait_for_program = true;
    options.process = torch_process(std::move(beam));
    std::unique_ptr<Program> listed;
    if (program) listed = std::make_unique<ListedProgram>(program->list());
    cutter_ =
        std::make_unique<LiveCutter>(*sheet_, torch_of("kerf:2"), log_, options, std::move(listed));
  }
  /// `on_rpm`: what the source tells of a spindle that is on, `off_rpm` of one that is off.
  void run(const RunningMachine& machine, double rate_hz, double on_rpm, double off_rpm) {
    const double end_s = machine.duration_s();
    for (int i = 0; i <= static_cast<int>(end_s * rate_hz) + 1; ++i) {
      const double t = std::min(end_s, i / rate_hz);
      AxisSample sample = machine.sample(t);
      const bool on = machine.at(t).motion.spindle != SpindleState::kStopped;
      sample.spindle_rpm = on ? on_rpm : off_rpm;
      cutter_->take(sample, i / rate_hz, false);
      cutter_->look();
    }
    cutter_->finish();
  }
  void run_edited(const RunningMachine& machine, double rate_hz,
                  const std::function<void(AxisSample&)>& edit) {
    for (int i = 0; i <= static_cast<int>(machine.duration_s() * rate_hz); ++i) {
      AxisSample sample = machine.sample(i / rate_hz);
      edit(sample);
      cutter_->take(sample, i / rate_hz, false);
    }
    cutter_->finish();
  }
  const Sheet& sheet() const { return *sheet_; }
  const LiveCutter& cutter() const { return *cutter_; }
  const std::vector<Finding>& findings() const { return log_.kept(); }
  std::size_t count(FindingId id) const {
    std::size_t found = 0;
    for (const Finding& finding : log_.kept()) found += finding.id == id ? 1 : 0;
    return found;
  }

 private:
  std::unique_ptr<Sheet> sheet_;
  FindingLog log_;
  std::unique_ptr<LiveCutter> cutter_;
};

/// The same parts as those of a dry run; each area and the rest within `tolerance_mm2`.
void expect_parts(const Sheet& found, const Sheet& wanted, double tolerance_mm2) {
  const std::vector<SheetPiece> a = found.pieces(), b = wanted.pieces();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].number, b[i].number);
    EXPECT_EQ(a[i].is_main(), b[i].is_main());
    EXPECT_NEAR(a[i].area_mm2, b[i].area_mm2, tolerance_mm2);
    EXPECT_NEAR(glm::length(a[i].min_mm - b[i].min_mm), 0, 0.02);
    EXPECT_NEAR(glm::length(a[i].max_mm - b[i].max_mm), 0, 0.02);
  }
}

// Contours of arcs lie within the arc tolerance (5 um) of the true ones, wherever they are divided.
TEST(LiveSheet, OnThePathTheBeamIsTheProgramsAndThePartsAreThoseOfTheDryRun) {
  const MotionList program = plates();
  const test::TorchShop dry(program.list());
  const RunningMachine machine(program.list());
  for (const double rate_hz : {20.0, 100.0, 500.0}) {
    TorchWatch watch(&program);
    watch.run(machine, rate_hz, kUntold, kUntold);
    expect_parts(watch.sheet(), dry.sheet(), 0.01 * 4 * 40);
    EXPECT_EQ(watch.count(FindingId::kNoBeam), 0U);
    const TorchStage& torch = test::torch_of(watch.cutter().stage());
    EXPECT_EQ(torch.totals().pierces, test::cuts_of(dry.report()).pierces);
    EXPECT_NEAR(torch.totals().cut_mm, test::cuts_of(dry.report()).cut_mm, 0.5);
    ASSERT_EQ(torch.freed().size(), dry.stage().process().freed().size());
    for (std::size_t i = 0; i < torch.freed().size(); ++i)
      EXPECT_EQ(torch.freed()[i].source, dry.stage().process().freed()[i].source);
  }
}

TEST(LiveSheet, WhatTheSourceTellsOfItsSpindleDoesNotMoveTheEndsOfCuts) {
  const MotionList program = plates();
  const RunningMachine machine(program.list());
  TorchWatch told(&program), untold(&program);
  told.run(machine, 50, 1000, 0);
  untold.run(machine, 50, kUntold, kUntold);
  EXPECT_EQ(told.sheet().digest(), untold.sheet().digest());
}

TEST(LiveSheet, WithoutAProgramTheSpindleIsTheBeam) {
  const MotionList program = plates();
  const test::TorchShop dry(program.list());
  const RunningMachine machine(program.list());
  TorchWatch watch(nullptr);
  watch.run(machine, 2000, 1000, 0);
  EXPECT_EQ(watch.count(FindingId::kNoBeam), 0U);
  // A contour that is closed to within a sample still comes free: the kerf is wider than the gap.
  // Chords of 0.02 mm and ends of cuts that are off by as much.
  expect_parts(watch.sheet(), dry.sheet(), 0.5);
}

TEST(LiveSheet, WhereNothingTellsOfTheBeamNothingIsCutAndItIsTold) {
  const MotionList program = plates();
  const RunningMachine machine(program.list());
  TorchWatch watch(nullptr);
  watch.run(machine, 100, kUntold, kUntold);
  EXPECT_EQ(watch.sheet().remaining_mm2(), 200 * 100);
  ASSERT_EQ(watch.count(FindingId::kNoBeam), 1U);
  EXPECT_EQ(watch.findings()[0].text,
            "nothing tells when the beam is on: the source has no spindle speed, and no program is "
            "followed (--program); nothing is cut until it does");
}

/// A log may hold "nan": the position, or whether the spindle turns, is not known for a while.
TEST(LiveSheet, WhatIsNotKnownForAWhileIsNotCutAcross) {
  MotionList program = torch_program();
  program.spindle(true).feed({105, 50, 1});
  const RunningMachine machine(program.list());
  for (const bool position : {true, false}) {
    TorchWatch watch(nullptr);
    double first = 0, last = 0;
    watch.run_edited(machine, 100, [&](AxisSample& sample) {
      const double x = sample.position[0];
      sample.spindle_rpm = 1000;
      if (x < 50 || x > 80) return;
      if (first == 0) first = x;
      last = x;
      if (position) {
        sample.known = 0b110;
        sample.position[0] = kUntold;
      } else {
        sample.spindle_rpm = kUntold;
      }
    });
    EXPECT_GT(last - first, 25);
    const double length = std::hypot(100, 48) * (last - first) / 100;
    if (position) {
      EXPECT_GT(watch.cutter().facts().incomplete, 100U);
      EXPECT_EQ(watch.count(FindingId::kSourceGap), 1U);
      EXPECT_TRUE(std::isfinite(watch.sheet().remaining_mm2()));
    }
    const double whole_mm2 = 2 * std::hypot(100, 48) + kPi;
    EXPECT_NEAR(20000 - watch.sheet().remaining_mm2(), whole_mm2 - 2 * length, 8);
  }
}

TEST(LiveSheet, BesideItsPathTheMachineCutsOnlyIfItsSpindleTurns) {
  const MotionList program = plates();
  const MotionList elsewhere = [] {
    MotionList list = torch_program();
    list.traverse({20, 80, 1}).spindle(true).feed({60, 90, 1});
    return list;
  }();
  const RunningMachine machine(elsewhere.list());
  TorchWatch silent(&program), told(&program);
  silent.run(machine, 50, kUntold, kUntold);
  told.run(machine, 50, 1000, 0);
  EXPECT_EQ(silent.sheet().remaining_mm2(), 200 * 100);
  EXPECT_LT(told.sheet().remaining_mm2(), 200 * 100 - 2 * 35);
}

}  // namespace
}  // namespace kerf
