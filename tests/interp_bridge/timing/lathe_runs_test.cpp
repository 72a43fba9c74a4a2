// Lathe programs (tests/live/lathe/programs) against the times that a real LinuxCNC 2.9 took for
// them on its sample sim/axis/lathe (tests/live/lathe/time_lathe): feeds per revolution, constant
// surface speed with and without a cap, threads, rigid taps, G71 and G70; and a spindle that gains
// 5000 rpm a second.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <sstream>

#include "tests/interp_bridge/timing/place_support.h"

namespace kerf {
namespace {

constexpr double kEach = 0.02;
/// Share of a motion's time by which a place of it may be passed early or late, besides
/// kSpindlePeriods.
constexpr double kEachMotion = 0.015;
constexpr double kInch_mm = 25.4;

/// tests/live/lathe/lathe.ini and hallib/basic_sim.tcl.
MachineLimits lathe_limits() {
  MachineLimits limits;
  for (const std::size_t axis : {0, 2}) {
    limits.axes[axis].present = true;
    limits.axes[axis].max_velocity = 3.333333 * kInch_mm;
    limits.axes[axis].max_acceleration = 20 * kInch_mm;
  }
  limits.max_linear_velocity_mm_per_s = 3.333334 * kInch_mm;
  return limits;
}

PlannerOptions lathe_spindle() {
  PlannerOptions options;
  options.spindle.accel_rpm_per_s = 5000;
  return options;
}

struct LatheRun {
  std::string program;
  double seconds = 0;  ///< mean
};

std::vector<LatheRun> recorded_runs() {
  std::vector<LatheRun> runs;
  std::ifstream file(LATHE_RUNS);
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    LatheRun& run = runs.emplace_back();
    std::getline(fields, run.program, ',');
    int count = 0;
    for (std::string number; std::getline(fields, number, ','); ++count) {
      run.seconds += std::stod(number);
    }
    run.seconds /= count;
  }
  return runs;
}

std::vector<Motion> motions_of(const std::string& program) {
  ProgramOptions options;
  options.path = std::string(LATHE_FOLDER "/programs/") + program + ".ngc";
  options.tool_table_path = LATHE_FOLDER "/lathe.tbl";
  options.interpreter = InterpreterChoice::kBridge;
  options.kerf_interp_path = KERF_INTERP_EXECUTABLE;
  options.machine.start_known = true;
  options.machine.tool_change_position = {2 * kInch_mm, 0, kInch_mm};
  ProgramRun run = run_program(options);
  EXPECT_TRUE(run.opened) << run.messages();
  return run.motions;
}

TEST(LatheRuns, TimesOfARealLinuxCnc) {
  const std::vector<LatheRun> runs = recorded_runs();
  ASSERT_GE(runs.size(), 7U);
  std::printf("%-16s %10s %10s %8s\n", "program", "measured s", "planned s", "error");
  for (const LatheRun& measured : runs) {
    const std::vector<Motion> motions = motions_of(measured.program);
    const double planned = moving_s(motions, plan_of(motions, lathe_limits(), lathe_spindle()));
    std::printf("%-16s %10.3f %10.3f %+7.2f %%\n", measured.program.c_str(), measured.seconds,
                planned, 100 * (planned / measured.seconds - 1));
    EXPECT_NEAR(planned, measured.seconds, kEach * measured.seconds) << measured.program;
  }
}

/// A place of a feed at a constant surface speed is passed late where the way is short of speed and
/// soon where the cap holds; of a thread when the spindle has turned so far.
TEST(LatheRuns, PlacesArePassedWhenARealLinuxCncPassedThem) {
  std::printf("%-16s %8s %8s %10s %9s\n", "program", "places", "corners", "in motion", "evenly");
  for (const auto& [name, samples] : recorded_places(LATHE_PLACES)) {
    const std::vector<Motion> motions = motions_of(name);
    const Passing passing =
        compare(motions, plan_of(motions, lathe_limits(), lathe_spindle()), samples, 0.3);
    std::printf("%-16s %8zu %8zu %10.2f %9.2f\n", name.c_str(), passing.compared,
                passing.in_corners, 1000 * passing.in_motion_worst_s, 1000 * passing.even_worst_s);
    EXPECT_GT(passing.compared, 200U) << name;
    EXPECT_LT(passing.worst_share, kEachMotion) << name;
  }
}

}  // namespace
}  // namespace kerf
