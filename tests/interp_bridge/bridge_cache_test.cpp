// Records that are kept: a second look at a program that has not changed starts no interpreter, and
// finds the same; whatever it hangs on, changed, is read anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <thread>

#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram =
    "G21 G90 F500\nT1 M6 G43\nG0 X0 Y0 Z5\no<sub> call\nG54 G1 X3\nM2\n";
constexpr const char* kSub = "o<sub> sub\nG1 X1 Z-1\no<sub> endsub\n";

/// A machine and a program, with an interpreter that counts how often it is started.
class BridgeCache : public testing::Test {
 protected:
  BridgeCache() {
    options.interpreter = InterpreterChoice::kBridge;
    options.kerf_interp_path =
        folder.write("kerf-interp", "#!/bin/sh\necho >> '" + folder.path("starts") + "'\nexec '" +
                                        KERF_INTERP_EXECUTABLE + "' \"$@\"\n");
    fs::permissions(options.kerf_interp_path, fs::perms::owner_all);
    options.cache_folder = folder.path("cache");
    options.path = folder.write("part.ngc", kProgram);
    folder.write("late/sub.ngc", kSub);
    fs::create_directory(folder.path("soon"));
    options.tool_table_path = folder.write("tool.tbl", "T1 P1 Z10 D6\n");
    options.machine.tool_lengths = true;
    options.machine.parameter_path = folder.write("var", "5220 1\n5221 7\n");
    options.machine.ini_path = folder.write("mill.ini", ini());
    options.machine.working_folder = folder.path("");
  }
  std::string ini(const std::string& more = {}) const {
    return "[RS274NGC]\nSUBROUTINE_PATH = " + folder.path("soon") + ":" + folder.path("late") +
           "\n" + more;
  }
  std::size_t starts() const {
    std::ifstream file(folder.path("starts"));
    return static_cast<std::size_t>(std::count(std::istreambuf_iterator<char>(file), {}, '\n'));
  }
  ProgramRun run() {
    // What a file system's clock cannot tell from now is over.
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
    return run_program(options);
  }
  /// Two runs, of which the second need not start it.
  void expect_kept() {
    const std::size_t before = starts();
    const ProgramRun first = run();
    EXPECT_EQ(starts(), before + 1) << first.messages();
    const ProgramRun second = run();
    EXPECT_EQ(starts(), before + 1);
    expect_equal(first, second);
  }
  void expect_not_kept() {
    const std::size_t before = starts();
    const ProgramRun first = run(), second = run();
    EXPECT_EQ(starts(), before + 2);
    expect_equal(first, second);
  }
  static void expect_equal(const ProgramRun& a, const ProgramRun& b) {
    EXPECT_EQ(a.messages(), b.messages());
    EXPECT_EQ(a.summary.canonical_commands, b.summary.canonical_commands);
    EXPECT_EQ(a.summary.files, b.summary.files);
    EXPECT_EQ(a.summary.foreign_lines, b.summary.foreign_lines);
    EXPECT_EQ(a.summary.has_program_end, b.summary.has_program_end);
    EXPECT_EQ(a.summary.stopped_early, b.summary.stopped_early);
    ASSERT_EQ(a.motions.size(), b.motions.size());
    for (std::size_t i = 0; i < a.motions.size(); ++i) {
      EXPECT_EQ(a.motions[i].to_mm, b.motions[i].to_mm);
      EXPECT_EQ(a.motions[i].source, b.motions[i].source);
      EXPECT_EQ(a.motions[i].tool, b.motions[i].tool);
      EXPECT_EQ(a.motions[i].feed_mm_per_min, b.motions[i].feed_mm_per_min);
    }
  }

  TestFolder folder;
  ProgramOptions options;
};

TEST_F(BridgeCache, ASecondLookStartsNoInterpreter) {
  expect_kept();
  EXPECT_TRUE(folder.nothing_left_behind());
  // What lies beside the user's files is what he put there.
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder.path(""))) files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 10U);  // kerf-interp, starts, cache, program, late, soon, table, var, INI, tmp
}

TEST_F(BridgeCache, WithoutAFolderNothingIsKept) {
  options.cache_folder.clear();
  expect_not_kept();
  EXPECT_FALSE(fs::exists(folder.path("cache")));
}

TEST_F(BridgeCache, AnythingChangedIsReadAnew) {
  expect_kept();
  folder.write("part.ngc", std::string("G0 Z9\n") + kProgram);
  expect_kept();
  folder.write("late/sub.ngc", "o<sub> sub\nG1 X2 Z-1\no<sub> endsub\n");
  expect_kept();
  folder.write("soon/sub.ngc", "o<sub> sub\nG1 X4 Z-2\no<sub> endsub\n");  // found before the other
  expect_kept();
  folder.write("tool.tbl", "T1 P1 Z11 D6\n");
  expect_kept();
  folder.write("var", "5220 1\n5221 8\n");
  expect_kept();
  folder.write("mill.ini", ini("[TRAJ]\nSPINDLES = 2\n"));
  expect_kept();
  options.block_delete = false;
  expect_kept();
  options.machine.startup_code = "G64 P0.1";
  expect_kept();
  options.machine.start[0] = 5;
  expect_kept();
  options.interp_fast = false;
  expect_kept();
}

TEST_F(BridgeCache, TheSamePathWithOtherContentsGivesOtherMotions) {
  const ProgramRun before = run();
  folder.write("late/sub.ngc", "o<sub> sub\nG1 X2 Z-1\no<sub> endsub\n");
  const ProgramRun after = run();
  ASSERT_EQ(before.motions.size(), after.motions.size());
  bool differs = false;
  for (std::size_t i = 0; i < before.motions.size(); ++i) {
    differs = differs || before.motions[i].to_mm != after.motions[i].to_mm;
  }
  EXPECT_TRUE(differs);
}

TEST_F(BridgeCache, ADamagedEntryIsReadAnew) {
  run();
  for (const auto& entry : fs::directory_iterator(folder.path("cache"))) {
    std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(entry.file_size() / 2));
    file.put('\x55');
  }
  expect_kept();  // begins with a start
}

TEST_F(BridgeCache, WhatCannotBeToldToComeAgainIsNotKept) {
  folder.write("part.ngc", "G21 F100\nG38.3 Z-5\nM2\n");
  expect_not_kept();
  folder.write("part.ngc", "G21 F100\nM101 P1\nM2\n");
  expect_not_kept();
  folder.write("part.ngc", "G21 F100\n(PRINT,hello)\nM2\n");
  expect_not_kept();
  folder.write("part.ngc", "G21 F100\nG1 X1.2.3\nM2\n");  // an error
  expect_not_kept();
  folder.write("part.ngc", "G21 F100\nG1 X1\n");  // no end
  expect_not_kept();
  folder.write("part.ngc", "G21 F100\nG1 X1\nM2\n");
  expect_kept();
  folder.write("mill.ini", ini("[PYTHON]\nPATH_APPEND = .\n"));
  expect_not_kept();
}

TEST_F(BridgeCache, AnEarlyStopIsNotKept) {
  std::string text = "G21 F100\n";
  for (int i = 0; i < 20'000; ++i) text += "G1 X" + std::to_string(i) + "\n";
  folder.write("part.ngc", text + "M2\n");
  Diagnostics diagnostics;
  const auto program = Program::open(options, diagnostics);
  ASSERT_TRUE(program);
  program->run([](std::span<const Motion>) { return false; }, {}, diagnostics);
  EXPECT_EQ(starts(), 1U);
  expect_kept();
}

}  // namespace
}  // namespace kerf
