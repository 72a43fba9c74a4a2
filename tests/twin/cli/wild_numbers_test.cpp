// Numbers that no machine has, streams that are full, programs without an end: through the
// executable.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

class WildNumbers : public testing::Test {
 protected:
  KerfResult kerf(std::vector<std::string> arguments) {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.folder = folder_.path();
    return run_kerf(call);
  }
  KerfResult run_listing(const std::string& moves, std::vector<std::string> more = {}) {
    folder_.write("part.canon",
                  "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
                  "    2 N1     CHANGE_TOOL(1)\n"
                  "    3 N2     START_SPINDLE_CLOCKWISE(0)\n"
                  "    4 N3     STRAIGHT_TRAVERSE(0, 0, 5, 0, 0, 0)\n"
                  "    5 N4     SET_FEED_RATE(300.0000)\n" +
                      moves + "    9 N9     PROGRAM_END()\n");
    std::vector<std::string> arguments = {"run",    "part.canon", "--stock", "box:-5,-5,-5:25,15,0",
                                          "--tool", "1=flat:6",   "--cell",  "0.5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return kerf(arguments);
  }
  KerfResult replay(const std::string& rows, std::vector<std::string> more = {}) {
    folder_.write("log.csv", "t_s,x_mm,y_mm,z_mm\n" + rows);
    std::vector<std::string> arguments = {
        "replay",    "log.csv",  "--stock", "box:-40,-30,-20:40,30,0",
        "--tool",    "1=flat:6", "--speed", "max",
        "--no-view", "--json",   "out.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return kerf(arguments);
  }
  Json report() { return Json::parse(read_file(folder_.file("out.json"))); }

  TestFolder folder_;
};

TEST_F(WildNumbers, APositionFarFromEveryMachineIsRefusedWithItsLine) {
  for (const char* const x : {"-100000000000", "1e14", "100000.1"}) {
    const KerfResult result =
        run_listing(std::string("    6 N5     STRAIGHT_FEED(") + x + ", 0, -1, 0, 0, 0)\n");
    EXPECT_EQ(result.exit_code, 4) << x;
    EXPECT_NE(result.err.find("part.canon:5: error: interpreter-error: X is at "), result.err.npos)
        << result.err;
    EXPECT_NE(result.err.find("100000 mm are the most"), result.err.npos) << result.err;
  }
  const KerfResult farthest = run_listing("    6 N5     STRAIGHT_FEED(100000, 0, -1, 0, 0, 0)\n");
  EXPECT_EQ(farthest.err.find("100000 mm are the most"), farthest.err.npos) << farthest.err;
}

TEST_F(WildNumbers, TenThousandTurnsAreTheMost) {
  const KerfResult result = run_listing("    6 N5     STRAIGHT_FEED(0, 0, -1, 0, 1e9, 0)\n");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("B is at 1000000000 degrees; 3600000 degrees are the most"),
            result.err.npos)
      << result.err;
}

TEST_F(WildNumbers, AnArcOfManyTurnsIsRefused) {
  const KerfResult result =
      run_listing("    6 N5     ARC_FEED(20, 0, 10, 0, 1000000, -2, 0, 0, 0)\n");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("turns; 1000 are the most"), result.err.npos) << result.err;
}

TEST_F(WildNumbers, AWildReadingIsDroppedCountedAndTold) {
  const std::string rows =
      "0.00,-20,0,-1\n0.01,-19.9,0,-1\n0.02,-799693870544434,0,-1\n0.03,-19.7,0,-1\n"
      "0.04,-19.6,1e11,-1\n0.05,-19.5,0,-1\n";
  const KerfResult result = replay(rows);
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.err.find("X reads -7.99694e+14 mm; no machine is beyond -100000 .. 100000 mm"),
            result.err.npos)
      << result.err;
  const Json live = report()["live"];
  EXPECT_EQ(live["samples"], 6);
  EXPECT_EQ(live["wild"], 2);
  EXPECT_EQ(live["gaps"], 0);
  EXPECT_NEAR(live["chord_mm"].get<double>(), 0.5, 1e-9);
}

TEST_F(WildNumbers, ThreeThousandColumnsAreNoLog) {
  std::string header = "t_s";
  for (int i = 0; i < 3000; ++i) header += ",x_mm";
  folder_.write("wide.csv", header + "\n0,1\n");
  const KerfResult result = kerf({"replay", "wide.csv", "--no-view", "--stock", "box:0,0,0:1,1,1"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_NE(result.err.find("the header has 3001 columns; 1000 are the most"), result.err.npos)
      << result.err;
}

TEST_F(WildNumbers, AFolderOrADeviceIsNoSavedWorkpiece) {
  run_listing("");
  KerfResult result = kerf({"run", "part.canon", "--stock", "state:."});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_NE(result.err.find(".: is a folder, not a saved workpiece"), result.err.npos)
      << result.err;
  result = kerf({"run", "part.canon", "--stock", "state:/dev/zero"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_NE(result.err.find("/dev/zero: not a saved workpiece"), result.err.npos) << result.err;
}

TEST_F(WildNumbers, AFileThatIsNoIni) {
  folder_.write("passwd", "root:x:0:0:root:/root:/bin/bash\n");
  const KerfResult result = run_listing("", {"--ini", "passwd"});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_NE(result.err.find("passwd: error: is no INI of a LinuxCNC machine"), result.err.npos)
      << result.err;
}

TEST_F(WildNumbers, APictureIsAPng) {
  const KerfResult result = run_listing("", {"--png", "part.JPG"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "kerf: error: --png part.JPG: pictures are written as PNG; a name that ends with .jpg "
            "says something else\n   hint: --png part.png\n");
}

class FullStreams : public WildNumbers {
 protected:
  /// By a shell: `redirection` behind the command. Status 128 + n: signal n.
  int status_of(const std::string& command, const std::string& redirection) {
    const std::string line = "cd '" + folder_.path() + "' && bash -c \"set -o pipefail; '" +
                             KERF_EXECUTABLE + "' " + command + " " + redirection + "\"";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
};

TEST_F(FullStreams, AReaderThatHasGoneEndsNothing) {
  ASSERT_EQ(run_listing("").exit_code, 0);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(status_of("run part.canon --ini part.canon", "2>&1 | true"), 2);
    EXPECT_EQ(status_of("run nix.ngc", "2>&1 | true"), 4);
    EXPECT_EQ(status_of("tools", "2>&1 | true"), 0);
    EXPECT_EQ(status_of("--help", "2>&1 | true"), 0);
  }
}

TEST_F(FullStreams, AFullDiskIsAFailure) {
  ASSERT_EQ(run_listing("").exit_code, 0);
  EXPECT_EQ(status_of("tools", ">/dev/full"), 4);
  EXPECT_EQ(status_of("--help", ">/dev/full"), 4);
  EXPECT_EQ(status_of("run nix.ngc", "2>/dev/full"), 4);
  EXPECT_EQ(status_of("run part.canon --ini part.canon", "2>/dev/full"), 4);
  EXPECT_EQ(status_of("run part.canon --stock box:-5,-5,-5:25,15,0 --tool 1=flat:6 --cell 0.5",
                      ">/dev/full 2>said"),
            4);
  EXPECT_NE(read_file(folder_.file("said")).find("standard output: No space left on device"),
            std::string::npos);
}

class Endless : public WildNumbers {
 protected:
  KerfResult run_program(const std::string& text, const char* interpreter) {
    folder_.write("part.ngc", text);
    return kerf({"run", "part.ngc", "--stock", "box:-5,-5,-5:25,15,0", "--tool", "1=flat:6",
                 "--cell", "1", "--interp", interpreter, "--max-seconds", "1"});
  }
};

TEST_F(Endless, ALoopThatStandsStill) {
  for (const char* const interpreter : {"bridge", "text"}) {
    const KerfResult result = run_program(
        "G21 G90 F100\nM3 S1000\no1 repeat [1000000000]\nG1 X1\no1 endrepeat\nM2\n", interpreter);
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find("are all repetitions, and move nothing; the program counts as "
                              "endless"),
              result.err.npos)
        << result.err;
  }
}

TEST_F(Endless, ALoopForDays) {
  const KerfResult result = run_program(
      "G21 G90 F1\nM3 S1000\no1 repeat [1000000000]\nG1 X20\nG1 X0\no1 endrepeat\nM2\n", "bridge");
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_NE(result.err.find("days; the program counts as endless"), result.err.npos) << result.err;
}

TEST_F(Endless, ProcessorTimeInAll) {
  folder_.write("part.ngc", "G21 G91 F100\no1 repeat [1000000000]\nG1 X0.0001\no1 endrepeat\nM2\n");
  const KerfResult result = kerf({"canon", "part.ngc", "--out", "out", "--max-cpu-seconds", "0.5"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_NE(result.err.find("the interpreter has used 0.5 s of processor time"), result.err.npos)
      << result.err;
}

}  // namespace
}  // namespace kerf
