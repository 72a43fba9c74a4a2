// When the tip passes places on its way: the programs of tests/live/kinematics/place_programs.ngc
// against where a real LinuxCNC 2.9 was, servo period by servo period
// (tests/live/kinematics/record_places), limits as MachineLimits::small_mill() has them.
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "tests/interp_bridge/timing/place_support.h"

namespace kerf {
namespace {

/// Servo periods. Within a motion, and where it passes a corner while the next one runs; and with
/// what the stops before it have added up to.
constexpr double kInMotion = 1;
constexpr double kInCorner = 3;
constexpr double kInProgram = 8;

std::map<std::string, std::string> programs() {
  std::map<std::string, std::string> out;
  std::ifstream file(PLACE_PROGRAMS);
  std::string* text = nullptr;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("% ", 0) == 0) {
      text = &out[line.substr(2)];
    } else if (text != nullptr) {
      *text += line + "\n";
    }
  }
  return out;
}

TEST(PlaceRuns, PassedWhenARealLinuxCncPassedThem) {
  const TestFolder folder;
  const auto texts = programs();
  const auto recorded = recorded_places(PLACE_TIMES);
  ASSERT_EQ(recorded.size(), texts.size());
  std::printf("%-16s %8s %8s %9s %10s %10s %9s\n", "program", "places", "off", "worst ms",
              "in motion", "in corner", "evenly");
  for (const auto& [name, samples] : recorded) {
    ProgramOptions options;
    options.path = folder.write("places.ngc", texts.at(name));
    options.interpreter = InterpreterChoice::kText;
    ProgramRun run = run_program(options);
    ASSERT_TRUE(run.opened) << run.messages();
    place_start(run.motions, {{0, 0, 0}}, true);
    const Passing passing = compare(run.motions, plan_of(run.motions), samples, 0.06);
    std::printf("%-16s %8zu %8zu %9.2f %10.2f %10.2f %9.2f\n", name.c_str(), passing.compared,
                passing.in_corners, 1000 * passing.worst_s, 1000 * passing.in_motion_worst_s,
                1000 * passing.corner_worst_s, 1000 * passing.even_worst_s);
    EXPECT_GT(passing.compared, 200U) << name;
    EXPECT_LT(passing.in_motion_worst_s, kInMotion * kPeriod_s) << name;
    EXPECT_LT(passing.corner_worst_s, kInCorner * kPeriod_s) << name;
    EXPECT_LT(passing.worst_s, kInProgram * kPeriod_s) << name;
    EXPECT_GT(passing.even_worst_s, 50 * kPeriod_s) << name;
  }
}

}  // namespace
}  // namespace kerf
