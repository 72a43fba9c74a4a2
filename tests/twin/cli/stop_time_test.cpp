// From Ctrl-C to the end of the process: at most 0.3 s, whatever kerf is busy with.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/base/sanitized.h"
#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr double kAllowed_s = kIsSanitized ? 1.5 : 0.3;
/// Clock ticks of /proc, and what kerf does between the signal and its being heard.
constexpr double kTick_s = 0.05;

/// How much longer things take by the clock than on a quiet computer.
double slowness() {
  double load = 0;
  std::ifstream("/proc/loadavg") >> load;
  return std::max(1.0, 2 * load / std::max(1U, std::thread::hardware_concurrency()));
}

class StopTime : public testing::Test {
 protected:
  StopTime() {
    mkdir(folder_.file("out").c_str(), 0700);
    mkdir(folder_.file("tmp").c_str(), 0700);
  }

  std::string listing_of(const std::string& moves) const {
    return folder_.write("part.canon",
                         "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
                         "    2 N1     CHANGE_TOOL(1)\n"
                         "    3 N2     START_SPINDLE_CLOCKWISE(0)\n"
                         "    4 N3     SET_FEED_RATE(3000.0000)\n"
                         "    5 N3     STRAIGHT_TRAVERSE(0, 0, 5, 0, 0, 0)\n"
                         "    6 N4     STRAIGHT_FEED(0, 0, -1, 0, 0, 0)\n" +
                             moves + "    9 N9     PROGRAM_END()\n");
  }

  KerfCall call(std::vector<std::string> arguments) const {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.arguments.insert(call.arguments.end(), {"--tool", "1=flat:6", "--threads", "1"});
    call.environment["TMPDIR"] = folder_.file("tmp");
    return call;
  }

  /// After `busy_s` of processor time, and not before it is ready.
  KerfResult stopped(const KerfCall& call, double busy_s, int signal = SIGINT) {
    RunningKerf kerf(call);
    EXPECT_TRUE(kerf.wait_until([&] { return kerf.cpu_s() >= busy_s; })) << kerf.err();
    const double spent_s = kerf.cpu_s();
    const Clock::time_point sent = Clock::now();
    kerf.send(signal);
    kerf.wait_for_end();
    const double took_s = std::chrono::duration<double>(Clock::now() - sent).count();
    const double worked_s = kerf.cpu_s() - spent_s;
    fmt::print("stopped after {:.3f} s, {:.2f} s of processor time\n", took_s, worked_s);
    EXPECT_LE(worked_s, kAllowed_s + kTick_s);
    EXPECT_LE(took_s, slowness() * (kAllowed_s + kTick_s));
    EXPECT_EQ(listing(folder_.file("tmp")), "") << "no temporary folder";
    return kerf.finish();
  }

  void expect_partial(const KerfResult& result, const std::string& reason) const {
    EXPECT_EQ(result.exit_code, 4) << result.err;
    const Json report = Json::parse(read_file(folder_.file("out/part.json")), nullptr, false);
    ASSERT_FALSE(report.is_discarded()) << result.err;
    EXPECT_EQ(report["partial"], true);
    EXPECT_EQ(report["partial_reason"], reason);
    EXPECT_EQ(report["findings"].back()["id"], "interrupted");
    EXPECT_NE(result.out.find("PARTIAL   " + reason), std::string::npos) << result.out;
  }

  TestFolder folder_;
};

constexpr const char* kCut = "interrupted before the end of the program";
constexpr const char* kWritten = "interrupted before all its files were written";

TEST_F(StopTime, WithinATurningMove) {
  const std::string program =
      listing_of("    7 N5     STRAIGHT_FEED(20, 5, -1, 100000, 360000, 0)\n");
  expect_partial(stopped(call({"run", program, "--stock", "box:-40,-30,-20:40,30,0", "--cell",
                               "0.2", "--json", folder_.file("out/part.json")}),
                         0.5),
                 kCut);
}

TEST_F(StopTime, WithinTheSearchForContacts) {
  const std::string program =
      listing_of("    7 N5     STRAIGHT_TRAVERSE(20, 5, -1, 100000, 360000, 0)\n");
  expect_partial(stopped(call({"run", program, "--stock", "box:-40,-30,-20:40,30,0", "--cell",
                               "0.2", "--json", folder_.file("out/part.json")}),
                         0.5, SIGTERM),
                 kCut);
}

/// Thousands of moves that each take a while.
TEST_F(StopTime, WithinLongMovesOnFineCells) {
  std::string moves;
  for (int i = 0; i < 20000; ++i) {
    moves += fmt::format("    7 N5     STRAIGHT_FEED({}, {}, -{}, 0, 0, 0)\n", i % 2 ? 0 : 300,
                         0.01 * i, 1 + 0.0001 * i);
  }
  expect_partial(stopped(call({"run", listing_of(moves), "--stock", "box:0,0,-20:300,200,0",
                               "--cell", "0.05", "--json", folder_.file("out/part.json")}),
                         0.7),
                 kCut);
}

TEST_F(StopTime, WhileALongProgramIsRead) {
  if (std::system("command -v rs274 >/dev/null") != 0) GTEST_SKIP() << "LinuxCNC is not installed";
  const std::string program =
      folder_.write("endless.ngc",
                    "G21 G90\nT1 M6\nM3 S1000\nF300\n#1=0\no1 while [1]\n#1=[#1+0.001]\n"
                    "G1 X[20*SIN[#1]] Y[#1] Z-1\no1 endwhile\nM2\n");
  for (const bool looks_first : {true, false}) {
    KerfCall run = call({"run", program, "--max-commands", "1000000000000", "--json",
                         folder_.file("out/part.json")});
    if (!looks_first) run.arguments.insert(run.arguments.end(), {"--stock", "box:0,0,-5:20,20,0"});
    const KerfResult result = stopped(run, 0.3);
    EXPECT_EQ(result.exit_code, 4) << result.err;
    const Json report = Json::parse(read_file(folder_.file("out/part.json")), nullptr, false);
    ASSERT_FALSE(report.is_discarded()) << result.err;
    EXPECT_EQ(report["partial_reason"], kCut);
  }
}

/// A blank that takes seconds to be made, before anything is read.
TEST_F(StopTime, WhileTheBlankIsFilled) {
  const std::string program = listing_of("");
  expect_partial(stopped(call({"run", program, "--stock", "cylinder:0,0,-300:0:400", "--model",
                               "octree", "--cell", "0.5", "--json", folder_.file("out/part.json")}),
                         0.3),
                 kCut);
}

TEST_F(StopTime, WhileAMeshIsWritten) {
  const std::string program = listing_of("");
  const KerfResult result = stopped(
      call({"run", program, "--stock", "box:0,0,-50:200,200,0", "--model", "octree", "--cell",
            "0.1", "--json", folder_.file("out/part.json"), "--stl", folder_.file("out/part.stl")}),
      1);
  expect_partial(result, kWritten);
  EXPECT_NE(result.err.find("interrupted: not written: " + folder_.file("out/part.stl")),
            std::string::npos)
      << result.err;
  EXPECT_EQ(listing(folder_.file("out")), "part.json") << "no half-written file";
}

TEST_F(StopTime, WhileAPictureIsDrawn) {
  const std::string program = listing_of("");
  const KerfResult result = stopped(
      call({"run", program, "--stock", "box:0,0,-50:200,200,0", "--model", "octree", "--cell",
            "0.1", "--json", folder_.file("out/part.json"), "--png", folder_.file("out/part.png")}),
      1);
  expect_partial(result, kWritten);
  EXPECT_EQ(listing(folder_.file("out")), "part.json") << "no half-written file";
}

/// What is there already stays, whole.
TEST_F(StopTime, WhatWasWrittenBeforeStays) {
  const std::string program = listing_of("");
  const std::string target = folder_.write("out/part.stl", "of the last run");
  stopped(call({"run", program, "--stock", "box:0,0,-50:200,200,0", "--model", "octree", "--cell",
                "0.1", "--stl", target}),
          1.5);
  EXPECT_TRUE(read_file(target) == "of the last run");
}

TEST_F(StopTime, WhileAPictureOfAProgramIsMade) {
  const std::string program =
      listing_of("    7 N5     STRAIGHT_FEED(20, 5, -1, 100000, 360000, 0)\n");
  const KerfResult result = stopped(call({"view", program, "--stock", "box:-40,-30,-20:40,30,0",
                                          "--cell", "0.2", "--png", folder_.file("out/part.png")}),
                                    0.5);
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_EQ(listing(folder_.file("out")), "");
}

}  // namespace
}  // namespace kerf
