// Recorded runs of a real LinuxCNC (live_logs) against the planner. Needs KERF_SHARED_DATA.
#include <gtest/gtest.h>

#include "tests/interp_bridge/timing/run_support.h"

namespace kerf {
namespace {

constexpr double kEachRun = 0.02;
constexpr double kAllRuns = 0.01;

/// Where the tip stood when the run began: home (machine 0, 0, 100) in the program's coordinates.
struct Recorded {
  const char* program;
  RecordedStart start;
  bool z_given;  ///< the first move sets Z, or rs274's 0 is as good
};

const std::vector<Recorded>& recorded_runs() {
  // G54 was 12.5, -7.25, -60 in the first three, 0 in the others; T1 is 40 mm long, T2 55.25.
  static const std::vector<Recorded> runs = {
      {"pocket_drill.ngc", {{-12.5, 7.25, 120}, 120, 104.75}, false},
      {"chips_piece.ngc", {{-12.5, 7.25, 160}}, true},
      {"chips_full.ngc", {{-12.5, 7.25, 160}}, true},
      {"cyc/arcs.ngc", {{0, 0, 0}}, true},
      {"cyc/drill_dwell.ngc", {{0, 0, 100}}, true},
      {"cyc/g61_zigzag.ngc", {{0, 0, 100}}, true},
      {"cyc/g64_zigzag.ngc", {{0, 0, 100}}, true},
      {"cyc/rapids.ngc", {{0, 0, 100}}, true},
      {"cyc/shortseg_g61.ngc", {{0, 0, 0}}, true},
      {"cyc/shortseg_g64.ngc", {{0, 0, 0}}, true},
      {"cyc/toolchange.ngc", {{0, 0, 0}}, true},
  };
  return runs;
}

/// The column servo_s: first line or tool change to last move, of the 1 kHz log. It is the fair one
/// for all programs: nml_s is read at 100 Hz, and holds tool preparation before the first move and
/// waits after the last, which depend on when the I/O task happens to look.
std::map<std::string, double> measured_seconds() {
  std::map<std::string, double> seconds;
  std::ifstream file(shared_data() / "live_logs" / "cycle_times.tsv");
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::string name, nml, servo;
    if (!std::getline(fields, name, '\t') || !std::getline(fields, nml, '\t') ||
        !std::getline(fields, servo, '\t') || name == "program" || name.front() == '#') {
      continue;
    }
    seconds[name] = std::stod(servo);
  }
  return seconds;
}

TEST(RecordedRuns, DurationsOfARealLinuxCnc) {
  if (shared_data().empty()) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
  const std::map<std::string, double> measured = measured_seconds();
  ASSERT_EQ(measured.size(), recorded_runs().size());
  const std::filesystem::path folder = shared_data() / "live_logs";
  double sum_measured = 0;
  double sum_planned = 0;
  std::printf("%-24s %10s %10s %8s\n", "program", "measured s", "planned s", "error");
  for (const Recorded& recorded : recorded_runs()) {
    ProgramOptions options;
    options.path = (folder / recorded.program).string();
    options.tool_table_path = (folder / "twin.tbl").string();
    options.interpreter = InterpreterChoice::kText;
    ProgramRun run = run_program(options);
    ASSERT_TRUE(run.opened) << run.messages();
    place_start(run.motions, recorded.start, recorded.z_given);
    const double planned = moving_s(run.motions, plan_of(run.motions));
    const double real = measured.at(recorded.program);
    std::printf("%-24s %10.3f %10.3f %+7.2f %%\n", recorded.program, real, planned,
                100 * (planned / real - 1));
    EXPECT_NEAR(planned, real, kEachRun * real) << recorded.program;
    sum_measured += real;
    sum_planned += planned;
  }
  std::printf("%-24s %10.3f %10.3f %+7.2f %%\n", "all", sum_measured, sum_planned,
              100 * (sum_planned / sum_measured - 1));
  EXPECT_NEAR(sum_planned, sum_measured, kAllRuns * sum_measured);
}

}  // namespace
}  // namespace kerf
