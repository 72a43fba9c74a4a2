#include "twin/cli/kerf_machine/machine_player.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/base/temporary_folder.h"
#include "twin/cli/kerf_machine/machine_loop.h"

namespace kerf {
namespace {

/// A program, read ahead.
class Played {
 public:
  explicit Played(const std::string& text, ServedFrame frame = ServedFrame::kMachine,
                  bool repeat = false) {
    options.program.path = folder_ / "part.ngc";
    options.repeat = repeat;
    write_file(options.program.path, text);
    Diagnostics diagnostics;
    auto program = Program::open(options.program, diagnostics);
    EXPECT_TRUE(program) << (diagnostics.empty() ? "" : to_string(diagnostics[0]));
    feed = std::make_unique<StepFeed>(options, std::move(program));
    player = std::make_unique<MachinePlayer>(*feed, frame);
    player->prepare({});
  }
  const SimulatedState& state() const { return player->state(); }

  StepFeedOptions options;
  std::unique_ptr<StepFeed> feed;
  std::unique_ptr<MachinePlayer> player;

 private:
  TemporaryFolder folder_;
};

constexpr const char* kCorner = "G1 X20 F3000\nG1 Y20\nM2\n";

/// Nearest distance of the positions from the corner of kCorner at 20, 0.
double nearest_to_corner(const std::string& mode) {
  Played played("G21 G90 " + mode + "\nG0 X0 Y0 Z0\n" + kCorner);
  double nearest = 1e9;
  while (played.player->advance(1e-4)) {
    nearest =
        std::min(nearest, std::hypot(played.state().position[0] - 20, played.state().position[1]));
  }
  EXPECT_EQ(played.state().position[0], 20);
  EXPECT_EQ(played.state().position[1], 20);
  return nearest;
}

TEST(MachinePlayer, RunsThePathThatThePlannerPlans) {
  EXPECT_LT(nearest_to_corner("G61.1"), 0.003);
  const double rounded = nearest_to_corner("G64 P0.5");
  EXPECT_GT(rounded, 0.1);
  EXPECT_LT(rounded, 0.5 + 1e-4);  // the positions beside the nearest one
}

TEST(MachinePlayer, TakesTheTimeOfTheTimeline) {
  Played played("G21 G90 G61.1\nG0 X0 Y0 Z0\nG1 X100 F1500\nG4 P0.5\nG1 X0\nM2\n");
  double before = 0;
  double dwell = 0;
  double fastest = 0;
  double clock = 0;
  while (played.player->advance(0.01)) {
    const double x = played.state().position[0];
    // Less than what was asked for while the interpreter is not there yet.
    const double passed = played.player->program_s() - clock;
    clock += passed;
    if (x == before && played.state().line == 0) dwell += passed;
    if (passed > 0.009) fastest = std::max(fastest, std::abs(x - before) / passed);
    before = x;
  }
  // 100 mm at 25 mm/s and 500 mm/s2, twice: 4.05 s each; and the dwell.
  EXPECT_NEAR(played.player->program_s(), 8.6, 0.02);
  EXPECT_NEAR(dwell, 0.5, 0.03);
  EXPECT_NEAR(fastest, 25, 0.05);  // between speeding up and braking
}

TEST(MachinePlayer, LinesToolsAndSpindleAreThoseOfTheStep) {
  Played played(
      "G21 G90 G61.1\nG0 X0 Y0 Z5\nT4 M6\nS500 M3\nG1 X10 F6000\nM4\nG1 X0\nM5\nG1 Y5\nM2\n");
  std::set<std::uint32_t> lines;
  while (played.player->advance(0.001)) {
    const SimulatedState& state = played.state();
    lines.insert(state.line);
    if (state.line == 5) {
      EXPECT_EQ(state.tool, 4);
      EXPECT_EQ(state.spindle_rpm, 500);
    }
    if (state.line == 7) {
      EXPECT_EQ(state.spindle_rpm, -500);
    }
    if (state.line == 9) {
      EXPECT_EQ(state.spindle_rpm, 0);
    }
  }
  EXPECT_EQ(lines, (std::set<std::uint32_t>{0, 5, 7, 9}));
  EXPECT_EQ(played.state().line, 0u);
}

TEST(MachinePlayer, RotaryAxesTurnWithTheMove) {
  Played played("G21 G90 G61.1\nG0 X0 Y0 Z0 A0\nG1 X10 A90 F600\nG1 A0 F3600\nM2\n");
  int checked = 0;
  bool turned_alone = false;
  while (played.player->advance(0.001)) {
    const SimulatedState& state = played.state();
    if (state.line == 3) {
      EXPECT_NEAR(state.position[3], 9 * state.position[0], 1e-6);
      ++checked;
    }
    if (state.line == 4) {
      EXPECT_EQ(state.position[0], 10);
      turned_alone = turned_alone || (state.position[3] > 30 && state.position[3] < 60);
    }
  }
  EXPECT_GT(checked, 10);
  EXPECT_TRUE(turned_alone);
}

TEST(MachinePlayer, RepeatsForEver) {
  Played played("G21 G90 G61.1\nG0 X0 Y0 Z2\nG1 X10 F60000\nZ-5\nM2\n", ServedFrame::kMachine,
                true);
  int arrivals = 0;
  bool was_deep = false;
  std::array<double, kSimulatedAxes> before = played.state().position;
  while (arrivals < 10) {
    const double time = played.player->program_s();
    ASSERT_TRUE(played.player->advance(0.002));
    const auto& at = played.state().position;
    const double way = std::hypot(at[0] - before[0], at[1] - before[1], at[2] - before[2]);
    // No jump between two passes: 100 mm/s is what the axes do.
    ASSERT_LE(way, 0.002 * 110) << time;
    const bool deep = at[2] < -4.999;
    if (deep && !was_deep) ++arrivals;
    was_deep = deep;
    before = at;
  }
}

TEST(MachineLoop, SkipsNothingWhenItsRateIsHeldAndTellsTheTime) {
  Played played("G21 G90 G61.1\nG0 X0 Y0 Z2\nG1 X100 F6000\nM2\n");
  StateBoard board;
  std::string told;
  MachineLoopOptions options;
  options.rate_hz = 100;
  options.speed = 10;
  options.faults = {parse_fault("jump:0").value()};
  publish_start(*played.player, options, board);
  EXPECT_EQ(board.read().state.position[2], 2 + kJump_mm);
  const MachineLoopResult result =
      run_machine_loop(options, *played.player, board, nullptr,
                       [&](const std::string& line) { told += line + "\n"; }, {});
  EXPECT_TRUE(result.finished);
  EXPECT_NEAR(result.elapsed_s * options.speed, played.player->program_s(), 0.11);
  EXPECT_NEAR(static_cast<double>(result.updates + result.skipped), result.elapsed_s * 100, 1.01);
  EXPECT_EQ(told.substr(0, 8), "started\n");
  EXPECT_NE(told.find("finished after "), std::string::npos);
  EXPECT_EQ(board.read().state.position[0], 100 + kJump_mm);
}

}  // namespace
}  // namespace kerf
