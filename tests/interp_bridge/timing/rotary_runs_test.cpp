// Four and five axes: the programs of tests/live/kinematics/rotary_programs.ngc against the times
// that a real LinuxCNC 2.9 took for them (tests/live/kinematics/time_rotary), limits as
// MachineLimits::small_mill() has them, from machine zero.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "tests/interp_bridge/timing/run_support.h"

namespace kerf {
namespace {

/// One servo period is a thousandth of the shorter ones; waits for commands are not known better.
constexpr double kWithin = 0.005;

std::map<std::string, std::string> programs() {
  std::map<std::string, std::string> out;
  std::ifstream file(ROTARY_PROGRAMS);
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

TEST(MeasuredRuns, FourAndFiveAxes) {
  const TestFolder folder;
  const auto texts = programs();
  std::ifstream times(ROTARY_TIMES);
  std::size_t compared = 0;
  for (std::string line; std::getline(times, line); ++compared) {
    const std::size_t comma = line.find(',');
    const std::string name = line.substr(0, comma);
    const double measured_s = std::stod(line.substr(comma + 1));
    ASSERT_EQ(texts.count(name), 1u) << name;
    ProgramOptions options;
    options.path = folder.write("rotary.ngc", texts.at(name));
    options.interpreter = InterpreterChoice::kText;
    ProgramRun run = run_program(options);
    ASSERT_TRUE(run.opened) << run.messages();
    place_start(run.motions, {{0, 0, 0}}, true);
    const double planned_s = moving_s(run.motions, plan_of(run.motions));
    std::printf("%-16s %8.3f %8.3f %+7.2f %%\n", name.c_str(), measured_s, planned_s,
                100 * (planned_s / measured_s - 1));
    EXPECT_NEAR(planned_s, measured_s, kWithin * measured_s) << name;
  }
  EXPECT_EQ(compared, texts.size());
}

}  // namespace
}  // namespace kerf
