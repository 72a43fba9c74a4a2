// Ctrl-C in the middle: what is known so far, marked as partial, and nothing left behind.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

constexpr const char* kListingHead =
    "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
    "    2 N1     SELECT_TOOL(1)\n"
    "    3 N1     CHANGE_TOOL(1)\n"
    "    4 N2     START_SPINDLE_CLOCKWISE(0)\n"
    "    5 N3     SET_FEED_RATE(300.0000)\n"
    "    6 N3     STRAIGHT_TRAVERSE(0.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
    "    7 N4     STRAIGHT_FEED(0.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n";

/// Processor time after which a run is where it takes long.
constexpr double kCutting_s = 1.0;

KerfCall interrupted_run(const TestFolder& folder, const std::string& program,
                         const std::string& cell_mm = "0.1") {
  KerfCall call;
  call.arguments = {"run",     program,
                    "--stock", "box:-5,-5,-5:25,15,0",
                    "--tool",  "1=flat:6",
                    "--cell",  cell_mm,
                    "--json",  folder.file("out/part.json"),
                    "--stl",   folder.file("out/part.stl")};
  mkdir(folder.file("out").c_str(), 0700);
  mkdir(folder.file("tmp").c_str(), 0700);
  call.environment["TMPDIR"] = folder.file("tmp");
  return call;
}

void expect_partial(const TestFolder& folder, const KerfResult& result) {
  EXPECT_EQ(result.exit_code, 4) << result.err;
  const Json report = Json::parse(read_file(folder.file("out/part.json")), nullptr, false);
  ASSERT_FALSE(report.is_discarded());
  EXPECT_EQ(report["partial"], true);
  EXPECT_EQ(report["partial_reason"], "interrupted before the end of the program");
  EXPECT_EQ(report["findings"].back()["id"], "interrupted");
  EXPECT_NE(result.out.find("PARTIAL   interrupted before the end of the program"),
            std::string::npos);
  // The mesh of what was cut is written as far as that takes no longer than a stop may
  // (stop_time_test.cpp).
  const bool mesh =
      result.err.find("not written: " + folder.file("out/part.stl")) == std::string::npos;
  EXPECT_EQ(listing(folder.file("out")), mesh ? "part.json part.stl" : "part.json")
      << "no half-written file";
  EXPECT_EQ(listing(folder.file("tmp")), "") << "no temporary folder";
}

TEST(Interrupt, ListingOnStdinThatDoesNotEnd) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TestFolder folder;
    RunningKerf kerf(interrupted_run(folder, "-"));
    kerf.write_input(kListingHead);
    ASSERT_TRUE(kerf.wait_until([] { return true; }));
    kerf.send(signal);
    expect_partial(folder, kerf.finish());
  }
}

TEST(Interrupt, EndlessProgram) {
  if (std::system("command -v rs274 >/dev/null") != 0) GTEST_SKIP() << "LinuxCNC is not installed";
  const TestFolder folder;
  const std::string program = folder.write(
      "endless.ngc",
      "G21 G90\nT1 M6\nM3 S1000\nF300\no1 while [1]\nG1 X20 Z-1\nG1 X0 Z-1\no1 endwhile\nM2\n");
  KerfCall call = interrupted_run(folder, program);
  call.arguments.insert(call.arguments.end(), {"--max-commands", "1000000000000"});
  RunningKerf kerf(call);
  ASSERT_TRUE(kerf.wait_until([&] { return !listing(folder.file("tmp")).empty(); }));
  kerf.send(SIGINT);
  expect_partial(folder, kerf.finish());
}

/// One motion that is cut for a long time, all of which has been read.
TEST(Interrupt, WithinALongMotion) {
  const TestFolder folder;
  const std::string program = folder.write("turn.canon",
                                           "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
                                           "    2 N1     CHANGE_TOOL(1)\n"
                                           "    3 N2     START_SPINDLE_CLOCKWISE(0)\n"
                                           "    4 N3     SET_FEED_RATE(300.0000)\n"
                                           "    5 N3     STRAIGHT_TRAVERSE(0, 0, 5, 0, 0, 0)\n"
                                           "    6 N4     STRAIGHT_FEED(0, 0, -1, 0, 0, 0)\n"
                                           "    7 N5     STRAIGHT_FEED(20, 5, -1, 0, 3600000, 0)\n"
                                           "    8 N6     PROGRAM_END()\n");
  RunningKerf kerf(interrupted_run(folder, program, "0.2"));
  ASSERT_TRUE(kerf.wait_until([&] { return kerf.cpu_s() > kCutting_s; }));
  const auto sent = std::chrono::steady_clock::now();
  kerf.send(SIGTERM);
  expect_partial(folder, kerf.finish());
  EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(10));
}

/// A traverse that turns through the workpiece: its contacts are looked for before it is cut.
TEST(Interrupt, WithinALongTraverse) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TestFolder folder;
    const std::string program =
        folder.write("turn.canon",
                     "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
                     "    2 N1     CHANGE_TOOL(1)\n"
                     "    3 N2     START_SPINDLE_CLOCKWISE(0)\n"
                     "    4 N3     STRAIGHT_TRAVERSE(0, 0, 5, 0, 0, 0)\n"
                     "    5 N4     STRAIGHT_TRAVERSE(0, 0, -1, 0, 0, 0)\n"
                     "    6 N5     STRAIGHT_TRAVERSE(20, 5, -1, 0, 3600000, 0)\n"
                     "    7 N6     PROGRAM_END()\n");
    RunningKerf kerf(interrupted_run(folder, program));
    ASSERT_TRUE(kerf.wait_until([&] { return kerf.cpu_s() > kCutting_s; }));
    const auto sent = std::chrono::steady_clock::now();
    kerf.send(signal);
    expect_partial(folder, kerf.finish());
    // It was minutes once.
    EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(10));
  }
}

TEST(Interrupt, BeforeThereIsABlank) {
  const TestFolder folder;
  KerfCall call = interrupted_run(folder, "-");
  call.arguments = {"run", "-", "--tool", "1=flat:6", "--json", folder.file("out/part.json")};
  RunningKerf kerf(call);
  kerf.write_input(kListingHead);
  ASSERT_TRUE(kerf.wait_until([] { return true; }));
  kerf.send(SIGINT);
  const KerfResult result = kerf.finish();
  EXPECT_EQ(result.exit_code, 4);
  const Json report = Json::parse(read_file(folder.file("out/part.json")), nullptr, false);
  ASSERT_FALSE(report.is_discarded());
  EXPECT_EQ(report["partial"], true);
  EXPECT_TRUE(report["stock"].is_null());
}

}  // namespace
}  // namespace kerf
