// Short programs whose durations were measured on LinuxCNC 2.9.0 (simulated machine with the limits
// of MachineLimits::small_mill(), 1 kHz servo thread), from home at machine 0, 0, 100: samples from
// the first to the last one that moved.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/interp_bridge/timing/run_support.h"

namespace kerf {
namespace {

using Line = std::function<std::string(int)>;

std::string repeat(int from, int to, const Line& line) {
  std::string text;
  for (int i = from; i <= to; ++i) text += line(i);
  return text;
}

struct Measured {
  const char* name;
  double seconds;
  /// Largest error, as a share. 2 % only where segments are so short that single servo periods
  /// count, and where the wait for an I/O look or a spindle's index is chance.
  double within;
  std::string text;
};

std::string squares(const std::string& mode) {
  return mode + "\nG0 X0 Y0 Z50\nF3000\n" +
         repeat(1, 3, [](int) { return "G1 X20\nG1 Y20\nG1 X0\nG1 Y0\n"; });
}

std::string wave(double step, double height, double per_step, int count, const std::string& head) {
  return head + repeat(1, count, [&](int i) {
           return fmt::format("G1 X{:.4f} Y{:.4f}\n", i * step, height * std::sin(i * per_step));
         });
}

std::string wave3(const std::string& mode) {
  return mode + "\nG0 X0 Y0 Z50\nF3000\n" + repeat(1, 400, [](int i) {
           return fmt::format("G1 X{:.4f} Y{:.4f} Z{:.4f}\n", i * .5, 3 * std::sin(i * .1),
                              50 + std::sin(i * .07));
         });
}

std::string zigzag(const std::string& mode) {
  return mode + "\nG0 X0 Y0 Z50\nF3000\n" +
         repeat(1, 100, [](int i) { return fmt::format("G1 X{:.4f} Y{}\n", i * .5, i % 2); });
}

std::string lines_and_arcs(const std::string& mode) {
  return mode + "\nG0 X0 Y0 Z50\nF3000\n" + repeat(0, 5, [](int i) {
           return fmt::format("G1 X{0} Y0\nG3 X{0} Y8 I0 J4\nG1 X{1} Y12\nG2 X{1} Y0 I0 J-6\n",
                              10 + i, 5 + i);
         });
}

std::vector<Measured> straight_programs() {
  const std::string start = "\nG0 X0 Y0 Z50\nF3000\n";
  return {
      {"one line", 3.237, 0.01, "G64" + start + "G1 X100\n"},
      {"squares G61", 7.180, 0.01, squares("G61")},
      {"squares G61.1", 7.037, 0.01, squares("G61.1")},
      {"squares G64", 5.386, 0.01, squares("G64")},
      {"squares G64 P0.1", 7.017, 0.01, squares("G64 P0.1")},
      {"squares G64 P1", 6.359, 0.01, squares("G64 P1")},
      {"wave 0.5 mm P0.01", 5.544, 0.01, wave3("G64 P0.01")},
      {"wave 0.5 mm P0.01 Q0", 5.563, 0.01, wave3("G64 P0.01 Q0")},
      {"zigzag 1 mm P0.01", 10.196, 0.01, zigzag("G64 P0.01")},
      {"zigzag 1 mm", 7.876, 0.01, zigzag("G64")},
      {"dense 0.1 mm", 3.218, 0.01, wave(.1, 1, .02, 1000, "G64" + start)},
      {"dense 0.1 mm P0.005", 4.333, 0.01, wave(.1, 2, .05, 1000, "G64 P0.005 Q0" + start)},
      {"dense 0.05 mm F6000", 4.104, 0.02, wave(.05, 1, .01, 1500, "G64" + start + "F6000\n")},
      {"dense 0.08 mm F6000", 4.173, 0.02, wave(.08, 1, .01, 1500, "G64" + start + "F6000\n")},
      {"dense 0.15 mm F6000", 4.747, 0.01, wave(.15, 2, .01, 1500, "G64" + start + "F6000\n")},
      {"stairs", 7.245, 0.01,
       "G64 P0.02\nG0 X0 Y0 Z50\nF1800\n" + repeat(1, 29,
                                                   [](int i) {
                                                     return fmt::format(
                                                         "G1 X{} Y{}\nG1 X{} Y{} Z{}\n", i * 2, i,
                                                         i * 2 + 2, i, 50 - i);
                                                   })},
      {"plunges", 10.229, 0.01,
       "G64 P0.01" + start +
           repeat(0, 7,
                  [](int i) {
                    return fmt::format("G1 Z40\nG1 X{} Y5\nG1 Z50\nG1 X{} Y0\n", i * 3, i * 3 + 2);
                  })},
      {"traverses", 9.589, 0.01,
       "G64\nG0 X0 Y0 Z50\n" +
           repeat(1, 15, [](int i) { return fmt::format("G0 X{} Y{}\n", 60 * (i % 2), i * 5); })},
      {"traverses and feeds", 4.725, 0.01,
       "G64" + start +
           repeat(1, 9,
                  [](int i) {
                    return fmt::format("G0 X{} Y{}\nG1 X{}\n", i * 10, i * 5, i * 10 + 5);
                  })},
      {"G93", 11.127, 0.01,
       "G64 P0.01\nG0 X0 Y0 Z50\nG93\n" +
           repeat(1, 19,
                  [](int i) { return fmt::format("G1 X{} Y{} F120\n", i * 10, i % 3 * 6); })},
      {"changing feeds", 5.387, 0.01,
       "G64 P0.01\nG0 X0 Y0 Z50\n" + repeat(1, 15,
                                            [](int i) {
                                              const std::array<int, 3> feeds = {3000, 600, 1500};
                                              return fmt::format(
                                                  "G1 X{} F{}\n", i * 5,
                                                  feeds[static_cast<std::size_t>(i % 3)]);
                                            })},
      // The I/O task looks every 0.1 s; where in that time the program begins is chance.
      {"coolant on and off", 6.650, 0.02,
       "G64 P0.01" + start +
           repeat(
               1, 8,
               [](int i) { return fmt::format("G1 X{}\nM8\nG1 X{}\nM9\n", i * 10, i * 10 + 5); })},
  };
}

std::vector<Measured> curved_programs() {
  const std::string start = "\nG0 X0 Y0 Z50\nF3000\n";
  return {
      {"circles r = 1", 2.672, 0.01,
       "G64 P0.01\nG0 X1 Y0 Z50\nF3000\n" + repeat(1, 5, [](int) { return "G3 X1 Y0 I-1 J0\n"; })},
      {"circles r = 10", 3.851, 0.01,
       "G64 P0.01\nG0 X10 Y0 Z50\nF3000\n" +
           repeat(1, 2, [](int) { return "G3 X10 Y0 I-10 J0\n"; })},
      {"helix", 4.410, 0.01,
       "G64 P0.01\nG0 X5 Y0 Z50\nF2400\n" +
           repeat(1, 4, [](int i) { return fmt::format("G3 X5 Y0 Z{} I-5 J0\n", 50 - 4 * i); })},
      {"lines and arcs P0.05", 8.938, 0.01, lines_and_arcs("G64 P0.05")},
      {"lines and arcs", 8.507, 0.01, lines_and_arcs("G64")},
      {"arcs and arcs", 5.025, 0.01,
       "G64" + start +
           repeat(0, 7,
                  [](int i) {
                    return fmt::format("G2 X{} Y0 I3 J0\nG3 X{} Y0 I2 J1\n", i * 10 + 6,
                                       i * 10 + 10);
                  })},
      {"dense circle 0.1 mm", 3.755, 0.01,
       "G64\nG0 X10 Y0 Z50\nF3000\n" + repeat(1, 1256,
                                              [](int i) {
                                                return fmt::format("G1 X{:.4f} Y{:.4f}\n",
                                                                   10 * std::cos(i * .01),
                                                                   10 * std::sin(i * .01));
                                              })},
  };
}

/// With an A axis of 90 deg/s and 360 deg/s2.
std::vector<Measured> rotary_programs() {
  return {
      {"A alone", 6.393, 0.01,
       "G64 P0.01\nG0 X0 Y0 Z50\nG0 A90\nG0 X10\nF3000\nG1 A0\nG1 A45\nG1 A30\nG0 X0\n"},
      {"X and A, A limits", 5.936, 0.01,
       "G64 P0.01\nG0 X0 Y0 Z50\nF1200\n" +
           repeat(1, 11, [](int i) { return fmt::format("G1 X{} A{}\n", i * 5, i * 30); })},
      {"X, Y and A", 7.818, 0.01,
       "G64 P0.01\nG0 X0 Y0 Z50\nF1200\n" +
           repeat(1, 41, [](int i) { return fmt::format("G1 X{} Y{} A{}\n", i * 2, i % 2, i); })},
  };
}

/// With a simulated spindle that gives its position.
std::vector<Measured> spindle_programs() {
  const std::string start = "G64 P0.01\nG0 X0 Y0 Z50\n";
  return {
      {"G95", 9.126, 0.01,
       start + "S1000 M3\nG95 F0.5\n" +
           repeat(1, 7, [](int i) { return fmt::format("G1 X{} Y{}\n", i * 5, i % 3 * 6); }) +
           "G94 F100\nM5\n"},
      {"G33", 9.841, 0.02,
       start + "S600 M3\n" +
           repeat(1, 5, [](int) { return "G33 Z40 K1\nG0 X2\nG0 Z50\nG0 X0\n"; }) + "M5\n"},
      {"G33.1", 7.912, 0.02,
       start + "S600 M3\n" +
           repeat(1, 3, [](int i) { return fmt::format("G33.1 Z40 K1\nG0 X{}\n", i); }) + "M5\n"},
  };
}

void compare(const std::vector<Measured>& table) {
  const TestFolder folder;
  std::printf("%-24s %10s %10s %8s\n", "program", "measured s", "planned s", "error");
  for (const Measured& measured : table) {
    const std::string path =
        folder.write("measured.ngc", "G21 G17 G40 G49 G54 G80 G90 G94\n" + measured.text + "M2\n");
    ProgramOptions options;
    options.path = path;
    options.interpreter = InterpreterChoice::kText;
    ProgramRun run = run_program(options);
    ASSERT_TRUE(run.opened) << run.messages();
    place_start(run.motions, {{0, 0, 100}}, true);
    const double planned = moving_s(run.motions, plan_of(run.motions));
    std::printf("%-24s %10.3f %10.3f %+7.2f %%\n", measured.name, measured.seconds, planned,
                100 * (planned / measured.seconds - 1));
    EXPECT_NEAR(planned, measured.seconds, measured.within * measured.seconds) << measured.name;
  }
}

TEST(MeasuredRuns, StraightPrograms) { compare(straight_programs()); }
TEST(MeasuredRuns, CurvedPrograms) { compare(curved_programs()); }
TEST(MeasuredRuns, SpindlePrograms) { compare(spindle_programs()); }
TEST(MeasuredRuns, RotaryPrograms) { compare(rotary_programs()); }

}  // namespace
}  // namespace kerf
