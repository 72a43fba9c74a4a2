// Programs that mix all words which do not move with moves under G64, G61 and G61.1, against runs
// of LinuxCNC 2.9.0 (simulated machine with the limits of MachineLimits::small_mill(), an ideal
// spindle that gives its position, 1 kHz servo thread, [TASK]CYCLE_TIME 0.001, [EMCIO]CYCLE_TIME
// 0.1): which words stop the machine, how long, and which corners stay sharp.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "tests/interp_bridge/timing/run_support.h"

namespace kerf {
namespace {

/// How far off a plan may be.
constexpr double kWithin = 0.01;

/// runs.tsv, a line each:  run NAME SECONDS[,SECONDS..] [bridge]   then   at X Y Z   of that run:
/// places of the control point, machine coordinates, the nearest to each corner of the program.
struct HaltRun {
  std::string name;
  /// First to last sample that moved; the mean of several runs.
  double seconds = 0;
  bool bridge_only = false;  ///< rs274 does not know a word of it, or prints nothing of it
  std::vector<Vec3> places_mm;
};

/// Where the I/O task is in its period and the spindle in its turn when a program begins is chance:
/// such a program was run several times, begun at moments spread evenly over these.
double mean_of(const std::string& list) {
  std::istringstream numbers(list);
  std::string number;
  double sum = 0;
  int count = 0;
  for (; std::getline(numbers, number, ','); ++count) sum += std::stod(number);
  return sum / count;
}

std::vector<HaltRun> recorded_runs() {
  std::vector<HaltRun> runs;
  std::ifstream file(HALT_RUNS "/runs.tsv");
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::string kind;
    fields >> kind;
    if (kind == "run") {
      HaltRun& run = runs.emplace_back();
      std::string seconds, interpreter;
      fields >> run.name >> seconds >> interpreter;
      run.seconds = mean_of(seconds);
      run.bridge_only = interpreter == "bridge";
    } else if (kind == "at") {
      Vec3 place_mm{0};
      fields >> place_mm.x >> place_mm.y >> place_mm.z;
      runs.back().places_mm.push_back(place_mm);
    }
  }
  return runs;
}

double distance_to(const PathPiece& piece, const Vec3& p) {
  if (!piece.curved) {
    const Vec3 way = piece.to_mm - piece.from_mm;
    const double square = glm::dot(way, way);
    const double part =
        square > 0 ? std::clamp(glm::dot(p - piece.from_mm, way) / square, 0.0, 1.0) : 0.0;
    return glm::length(p - piece.from_mm - part * way);
  }
  const Vec3& axis = piece.arc.axis;
  const Vec3 out = piece.from_mm - piece.arc.center_mm;
  const double rise = glm::dot(piece.to_mm - piece.from_mm, axis);
  const Vec3 flat = out - glm::dot(out, axis) * axis;
  const Vec3 side = glm::cross(axis, flat);
  const Vec3 foot = piece.from_mm - flat;
  const double sweep = piece.arc.sweep_rad;
  const double angle = std::atan2(glm::dot(p - foot, side), glm::dot(p - foot, flat));
  double least = std::numeric_limits<double>::infinity();
  for (const double turn : {angle - 2 * kPi, angle, angle + 2 * kPi}) {
    const double on = std::clamp(turn, std::min(sweep, 0.0), std::max(sweep, 0.0));
    const Vec3 at = foot + std::cos(on) * flat + std::sin(on) * side + on / sweep * rise * axis;
    least = std::min(least, glm::length(p - at));
  }
  return least;
}

/// rs274 is told no lengths (coded_offset()), so that the motions' offsets are without them: what
/// the program's own blocks have put in force when each of its lines is run.
std::vector<Vec3> lengths_by_line(const std::string& path) {
  constexpr std::array<double, 4> kRow_mm = {0, 40, 55.25, 48.5};
  std::vector<Vec3> lengths_mm(1, Vec3{0});
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    double z_mm = lengths_mm.back().z;
    unsigned row = 0;
    if (line.find("G49") != line.npos) z_mm = 0;
    if (std::sscanf(line.c_str(), "G43 H%u", &row) == 1) z_mm = kRow_mm.at(row);
    std::sscanf(line.c_str(), "G43.1 Z%lf", &z_mm);
    lengths_mm.push_back({0, 0, z_mm});
  }
  return lengths_mm;
}

/// Of the pieces in machine coordinates.
double path_error_mm(const std::vector<Motion>& motions, const Plan& plan,
                     const std::vector<Vec3>& places_mm) {
  double worst = 0;
  for (const Vec3& place : places_mm) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t piece = 0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      for (; piece < plan.pieces_before[i]; ++piece) {
        const Vec3 tip = place - motions[i].tool_offset_mm;
        least = std::min(least, distance_to(plan.pieces[piece], tip));
      }
    }
    worst = std::max(worst, least);
  }
  return worst;
}

void compare(InterpreterChoice interpreter) {
  const std::vector<HaltRun> runs = recorded_runs();
  ASSERT_GE(runs.size(), 40U);
  const TestFolder folder;
  const std::string table = folder.write("tool.tbl",
                                         "T1 P1 Z40.000 D6.000\nT2 P2 Z55.250 D5.000\n"
                                         "T3 P3 Z48.500 D10.000\n");
  std::printf("%-24s %10s %10s %8s %9s\n", "program", "measured s", "planned s", "error",
              "path mm");
  for (const HaltRun& measured : runs) {
    if (measured.bridge_only && interpreter == InterpreterChoice::kText) continue;
    ProgramOptions options;
    options.path = std::string(HALT_RUNS "/") + measured.name + ".ngc";
    options.tool_table_path = table;
    options.interpreter = interpreter;
    options.machine.start[2] = 100;
    options.machine.start_known = true;
    options.machine.tool_lengths = true;
#ifdef KERF_INTERP_EXECUTABLE
    options.kerf_interp_path = KERF_INTERP_EXECUTABLE;
#endif
    ProgramRun run = run_program(options);
    ASSERT_TRUE(run.opened) << run.messages();
    if (interpreter == InterpreterChoice::kText) {
      place_start(run.motions, {{0, 0, 100}}, true);
      const std::vector<Vec3> lengths_mm = lengths_by_line(options.path);
      for (Motion& m : run.motions) {
        m.tool_offset_mm = lengths_mm.at(m.source.line) - m.length.tip_shift_mm;
      }
    }
    PlannerOptions wanted;
    wanted.with_path = true;
    const Plan plan = plan_of(run.motions, MachineLimits::small_mill(), wanted);
    const double planned = moving_s(run.motions, plan);
    const double off_mm = path_error_mm(run.motions, plan, measured.places_mm);
    std::printf("%-24s %10.3f %10.3f %+7.2f %% %8.4f\n", measured.name.c_str(), measured.seconds,
                planned, 100 * (planned / measured.seconds - 1), off_mm);
    EXPECT_NEAR(planned, measured.seconds, kWithin * measured.seconds) << measured.name;
    EXPECT_LT(off_mm, 0.01) << measured.name;
  }
}

TEST(HaltRuns, AsListed) { compare(InterpreterChoice::kText); }

#ifdef KERF_INTERP_EXECUTABLE
TEST(HaltRuns, AsRecordedByKerfInterp) { compare(InterpreterChoice::kBridge); }
#endif

}  // namespace
}  // namespace kerf
