// NC programs through kerf-interp.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <thread>

#include "interp_bridge/interpreter_process.h"
#include "interp_bridge/motion_fold.h"
#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

class BridgeProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.interpreter = InterpreterChoice::kBridge;
    options_.kerf_interp_path = KERF_INTERP_EXECUTABLE;
  }
  /// After every test: no child, no folder.
  void TearDown() override {
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
    EXPECT_TRUE(folder_.nothing_left_behind());
  }
  ProgramRun run(const std::string& text) {
    options_.path = folder_.write("part.ngc", text);
    return run_program(options_);
  }
  std::string part() const { return folder_.path("part.ngc"); }

  TestFolder folder_;
  ProgramOptions options_;
};

std::vector<std::uint32_t> lines_of(const std::vector<Motion>& motions) {
  std::vector<std::uint32_t> lines;
  for (const Motion& motion : motions) lines.push_back(motion.source.line);
  return lines;
}

TEST_F(BridgeProgram, MotionsCarryTheirLinesAndAllTheirDigits) {
  const ProgramRun run = this->run(
      "G21 G90\n\n(comment)\nG0 X1 Y2 Z3\nN900 G1 X[1/3] F300\nG2 X20 I9.83333333333333\nM2\n");
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.motions.size(), 4U);
  EXPECT_EQ(lines_of(run.motions), (std::vector<std::uint32_t>{4, 5, 6, 7}));
  EXPECT_FALSE(run.motions[0].start_known);
  EXPECT_DOUBLE_EQ(run.motions[1].to_mm.x, 1.0 / 3) << "rs274 prints 0.3333";
  EXPECT_EQ(run.motions[2].kind, MotionKind::kArc);
  EXPECT_NEAR(run.motions[2].arc.sweep_rad, -kPi, 1e-6);
  EXPECT_EQ(run.motions[3].kind, MotionKind::kProgramEnd);
  EXPECT_EQ(run.summary.interpreter, "bridge");
  EXPECT_EQ(run.summary.program_lines, 7U);
  EXPECT_TRUE(run.summary.has_program_end);
}

TEST_F(BridgeProgram, BlockDelete) {
  EXPECT_EQ(run("G0 X1\n/G0 X2\nG0 X3\nM2\n").motions.size(), 3U);
  options_.block_delete = false;
  EXPECT_EQ(run("G0 X1\n/G0 X2\nG0 X3\nM2\n").motions.size(), 4U);
}

TEST_F(BridgeProgram, SubroutinesInOtherFilesKeepTheirNamesAndLines) {
  folder_.write("deep.ngc", "o<deep> sub\n\nG1 X[#1] F100\no<deep> endsub\nM2\n");
  folder_.write("sub.ngc",
                "o<sub> sub\nG1 Y[#1] F100\no<deep> call [#1]\nG1 Z1\no<sub> endsub\nM2\n");
  const ProgramRun run = this->run("G0 X0 Y0 Z0\no<sub> call [5]\no<deep> call [7]\nG0 X9\nM2\n");
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.motions.size(), 7U);
  ASSERT_EQ(run.summary.files,
            (std::vector<std::string>{part(), folder_.path("sub.ngc"), folder_.path("deep.ngc")}));
  const std::vector<SourceRef> expected = {{0, 1}, {1, 2}, {2, 3}, {1, 4}, {2, 3}, {0, 4}, {0, 5}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(run.motions[i].source.file, expected[i].file) << i;
    EXPECT_EQ(run.motions[i].source.line, expected[i].line) << i;
  }
}

TEST_F(BridgeProgram, CutterCompensationKeepsTheLineOfEachMove) {
  options_.tool_table_path = folder_.write("tool.tbl", "T1 P1 D2\n");
  const ProgramRun run = this->run(
      "G21 G90 F100\nG0 X0 Y0\nG41.1 D2\nG1 X10 Y0\nG1 X20\nG1 Y20\nG1 X30\nG40\nG0 X50\nM2\n");
  EXPECT_EQ(run.messages(), "");
  std::vector<std::uint32_t> feeds;
  for (const Motion& motion : run.motions) {
    if (motion.kind == MotionKind::kFeed) feeds.push_back(motion.source.line);
  }
  EXPECT_EQ(feeds, (std::vector<std::uint32_t>{4, 5, 6, 7}));
}

TEST_F(BridgeProgram, ErrorsNameFileLineAndCallers) {
  EXPECT_EQ(run("G0 X1\nG1 X2 F100\nG0 X1 X2\nM2\n").messages(),
            part() +
                ":3: error: Multiple x words on one line\n"
                "     3 | G0 X1 X2\n");
  folder_.write("sub.ngc", "o<sub> sub\nG0 X1\nG77\no<sub> endsub\nM2\n");
  EXPECT_EQ(
      run("G0 X1\no100 sub\no<sub> call\no100 endsub\no100 call\nM2\n").messages(),
      folder_.path("sub.ngc") +
          ":3: error: Unknown g code used\n     3 | G77\n   hint: LinuxCNC has no such code and "
          "stops here, too, but where an INI remaps it (--ini); called from " +
          part() + ":3, from " + part() + ":5\n");
}

TEST_F(BridgeProgram, MissingSubroutineAndMissingEnd) {
  const std::string missing = run("G0 X1\no<nix> call\nM2\n").messages();
  EXPECT_EQ(missing.rfind(part() + ":2: error: EOF in file:" + part() +
                              " seeking o-word: o<nix> from line: 2\n     2 | o<nix> call\n",
                          0),
            0U)
      << missing;
  EXPECT_EQ(run("G0 X1\nG0 X2\n").messages(),
            part() +
                ":2: warning: the program has no end: File ended with no percent sign or program "
                "end\n   hint: end it with M2 or M30, or put it between two lines of %\n");
}

TEST_F(BridgeProgram, RecursionWithoutEnd) {
  const ProgramRun run = this->run("o100 sub\no100 call\no100 endsub\no100 call\nM2\n");
  ASSERT_EQ(run.diagnostics.size(), 1U) << run.messages();
  EXPECT_EQ(run.diagnostics[0].line, 2);
  EXPECT_EQ(run.diagnostics[0].message, "Too many subroutine levels");
}

TEST_F(BridgeProgram, EndlessProgramsAreStoppedWhereTheyLoop) {
  options_.max_commands = 1000;
  const ProgramRun moving = run("G0 X0\no1 while [1]\nG1 X1 F100\nG1 X0\no1 endwhile\nM2\n");
  ASSERT_EQ(moving.diagnostics.size(), 1U);
  EXPECT_EQ(moving.diagnostics[0].message,
            "more than 1000 canonical commands; the program counts as endless");
  EXPECT_TRUE(moving.summary.stopped_early);
  options_.max_commands = 0;
  options_.max_silent_s = 0.6;
  const ProgramRun silent = run("G0 X0\n\no1 while [1]\n#1=[#1+1]\no1 endwhile\nM2\n");
  ASSERT_EQ(silent.diagnostics.size(), 1U);
  EXPECT_GE(silent.diagnostics[0].line, 3);
  EXPECT_LE(silent.diagnostics[0].line, 5);
  EXPECT_EQ(silent.diagnostics[0].message,
            "no motion or other command for 0.6 s; the program counts as endless");
}

TEST_F(BridgeProgram, MetricTablesAreMetricAndInchTablesInch) {
  options_.tool_table_path = folder_.write("tool.tbl", "T1 P1 D6 Z10\nT2 P2 D10 Z30\n");
  // The radius of G41 D1 is that of the table: the path lies 3 mm to the left.
  const std::string text = "G21 G90 F100\nG0 X0 Y0\nG41 D1\nG1 X10 Y0\nG1 X20\nG40\nG0 X50\nM2\n";
  const ProgramRun metric = run(text);
  EXPECT_EQ(metric.messages(), "");
  ASSERT_GE(metric.motions.size(), 3U);
  EXPECT_NEAR(metric.motions[2].to_mm.y, 3, 1e-9);
}

TEST_F(BridgeProgram, WithoutAKnownMachineToolLengthsDoNotCount) {
  options_.tool_table_path = folder_.write("tool.tbl", "T1 P1 D6 Z10\n");
  const std::string text = "G21 G90\nT1 M6\nG43 H1\nG0 X1\nG0 Z5\nM2\n";
  EXPECT_EQ(run(text).motions[1].to_mm, Vec3(1, 0, 0));
  options_.machine.tool_lengths = true;
  options_.machine.start = {0, 0, 100, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(run(text).motions[1].to_mm, Vec3(1, 0, 90));
}

TEST_F(BridgeProgram, TheFirstMoveBeginsWhereTheMachineStands) {
  options_.tool_table_path = folder_.write("tool.tbl", "T1 P1 D6 Z10\n");
  options_.machine.tool_lengths = true;
  options_.machine.start = {5, 7, 100, 30, 0, 0, 0, 0, 0};
  options_.machine.start_known = true;
  const ProgramRun plain = run("G21 G90\nG10 L2 P1 X1 Y2 Z3 A10 R90\nT1 M6 G43 H1\nG0 Z5 A0\nM2\n");
  EXPECT_EQ(plain.messages(), "");
  const Motion* move = nullptr;
  for (const Motion& m : plain.motions) {
    if (m.kind == MotionKind::kTraverse) move = &m;
  }
  ASSERT_NE(move, nullptr);
  EXPECT_TRUE(move->start_known);
  // Machine = R(90 degrees) * work + (1, 2, 3) + (0, 0, 10) of the tool.
  EXPECT_NEAR(move->from_mm.x, 5, 1e-9);
  EXPECT_NEAR(move->from_mm.y, -4, 1e-9);
  EXPECT_NEAR(move->from_mm.z, 87, 1e-9);
  EXPECT_NEAR(move->from_abc_deg[0], 20, 1e-9);
  EXPECT_NEAR(move->to_mm.x, 5, 1e-9);
  EXPECT_NEAR(move->to_mm.y, -4, 1e-9);
  EXPECT_NEAR(move->to_mm.z, 5, 1e-9);
}

TEST_F(BridgeProgram, ToolLengthsMoveTheTipOfAStandingMachine) {
  options_.machine.tool_lengths = true;
  options_.tool_table_path = folder_.write("tool.tbl", "T1 P1 D6 Z10\nT2 P2 D10 Z30\n");
  const ProgramRun run =
      this->run("G21 G90\nT1 M6 G43 H1\nG0 X0 Y0 Z50\nT2 M6\nG43 H2\nG0 X10\nG0 Z40\nM2\n");
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.motions.size(), 6U);
  EXPECT_EQ(run.motions[1].to_mm, Vec3(0, 0, 50));
  EXPECT_EQ(run.motions[2].kind, MotionKind::kToolChange);
  EXPECT_EQ(run.motions[2].tool, 2);
  // The longer tool reaches 20 mm farther down: no phantom Z, the machine stands.
  EXPECT_EQ(run.motions[3].from_mm, Vec3(0, 0, 30));
  EXPECT_EQ(run.motions[3].to_mm, Vec3(10, 0, 30));
  EXPECT_EQ(run.motions[4].to_mm, Vec3(10, 0, 40));
}

TEST_F(BridgeProgram, ToolNumbers) {
  const ProgramRun run = this->run("T7 M6\nG0 X1\nM61 Q9\nG0 X2\nT0 M6\nG0 X3\nM2\n");
  EXPECT_EQ(run.messages(), "");
  std::vector<int> tools;
  for (const Motion& m : run.motions) {
    if (m.kind == MotionKind::kTraverse) tools.push_back(m.tool);
  }
  EXPECT_EQ(tools, (std::vector<int>{7, 9, 0}));
}

TEST_F(BridgeProgram, SplinesAreCutWithinTheirTolerance) {
  // G5: a cubic with control points (0,0) (0,40) (40,40) (40,0).
  const ProgramRun run =
      this->run("G21 G90 G17 F100\nG0 X0 Y0 Z1\nG5 I0 J40 P0 Q40 X40 Y0\nG0 Z5\nM2\n");
  EXPECT_EQ(run.messages(), "");
  EXPECT_EQ(run.summary.lost_splines, 0U);
  const auto bezier = [](double t) {
    const double s = 1 - t;
    return Vec3(3 * s * t * t * 40 + t * t * t * 40, 3 * s * s * t * 40 + 3 * s * t * t * 40, 1);
  };
  std::vector<Motion> feeds;
  for (const Motion& m : run.motions) {
    if (m.kind == MotionKind::kFeed) feeds.push_back(m);
  }
  ASSERT_GT(feeds.size(), 20U);
  EXPECT_LT(feeds.size(), 400U);
  EXPECT_NEAR(glm::length(feeds.back().to_mm - Vec3(40, 0, 1)), 0, 1e-9);
  for (double t = 0; t <= 1; t += 1.0 / 512) {
    const Vec3 p = bezier(t);
    double nearest = 1e9;
    for (const Motion& m : feeds) {
      const Vec3 d = m.to_mm - m.from_mm;
      const double at = std::min(1.0, std::max(0.0, glm::dot(p - m.from_mm, d) / glm::dot(d, d)));
      nearest = std::min(nearest, glm::length(p - m.from_mm - at * d));
    }
    EXPECT_LE(nearest, kSplineChord_mm) << t;
    if (nearest > kSplineChord_mm) break;
  }
  EXPECT_EQ(feeds.front().source.line, 3U);
}

TEST_F(BridgeProgram, UvwAndRotaryAxes) {
  const ProgramRun run = this->run("G21 G90 F100\nG0 X1 U2\nG1 X2 V3 W4\nG1 A90\nM2\n");
  EXPECT_EQ(run.messages(), "");
  EXPECT_TRUE(run.summary.has_rotary_motion);
  EXPECT_EQ(run.motions[1].from_uvw_mm, Vec3(2, 0, 0));
  EXPECT_EQ(run.motions[1].to_uvw_mm, Vec3(2, 3, 4));
  EXPECT_EQ(run.motions[2].from_uvw_mm, Vec3(2, 3, 4));
  EXPECT_EQ(run.motions[2].to_abc_deg[0], 90);
}

TEST_F(BridgeProgram, UserMCodesAndM66AreNoted) {
  const ProgramRun run = this->run("M110 P3\nG0 X1\nM66 P0 L0\nM110 P3\nM2\n");
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.summary.notes.size(), 2U);
  EXPECT_EQ(run.summary.notes[0].text, "M110 P3");
  EXPECT_EQ(run.summary.notes[0].count, 2U);
  EXPECT_EQ(run.summary.notes[0].source.line, 1U);
  EXPECT_EQ(run.summary.notes[1].text, "M66 of digital input 0");
}

TEST_F(BridgeProgram, ProbesFindWhatTheyMustAndNothingElse) {
  const ProgramRun run = this->run(
      "G21 G90 F100\nG0 X0 Y0 Z5\nG38.2 Z-10\no1 if [#5070 NE 1]\nG0 X99\no1 endif\n"
      "G0 Z5\nG38.3 Z-10\no2 if [#5070 NE 0]\nG0 X99\no2 endif\nG0 X[#5063]\nM2\n");
  EXPECT_EQ(run.messages(), "");
  for (const Motion& m : run.motions) EXPECT_NE(m.to_mm.x, 99) << m.source.line;
  EXPECT_EQ(run.motions[run.motions.size() - 2].to_mm.x, -10);
}

TEST_F(BridgeProgram, ParametersAreReadInMachineUnitsAndNotWritten) {
  const std::string text =
      "5161\t0\n5162\t0\n5163\t0\n5210\t0\n5211\t0\n5220\t2\n5221\t0\n5241\t7\n5242\t0\n5243\t0\n";
  options_.machine.parameter_path = folder_.write("linuxcnc.var", text);
  // G55 from the file: G53 X0 is X-7 of it.
  const ProgramRun run = this->run("G21 G90\nG0 X0 Y0 Z0\nG53 G0 X0\n#31=5\nM2\n");
  EXPECT_EQ(run.messages(), "");
  EXPECT_NEAR(run.motions[1].to_mm.x, -7, 1e-9);
  EXPECT_EQ(text_of(options_.machine.parameter_path), text);
  options_.machine.inch_machine = true;
  EXPECT_NEAR(this->run("G21 G90\nG0 X0 Y0 Z0\nG53 G0 X0\nM2\n").motions[1].to_mm.x, -177.8, 1e-6);
  options_.machine.inch_machine = false;
  options_.machine.parameter_path = folder_.write("bad.var", "5163 0\n5161 0\n5162 0\n");
  EXPECT_EQ(this->run("G0 X0\nM2\n").messages(),
            folder_.path("bad.var") + ": error: Parameter file out of order\n");
  options_.machine.parameter_path = folder_.path("nix.var");
  EXPECT_EQ(
      this->run("G0 X0\nM2\n").messages(),
      part() + ": error: cannot read " + folder_.path("nix.var") + ": No such file or directory\n");
}

TEST_F(BridgeProgram, StartupCodeAndAxisMask) {
  options_.machine.startup_code = "G20 G64 P0.01";
  const ProgramRun run = this->run("G0 X1\nG1 X2 F10\nM2\n");
  EXPECT_EQ(run.messages(), "");
  EXPECT_NEAR(run.motions[0].to_mm.x, 25.4, 1e-12);
  EXPECT_FLOAT_EQ(run.motions[1].blend_tolerance_mm, 0.254F);
  options_.machine.startup_code = "G999";
  const ProgramRun bad = this->run("G0 X1\nM2\n");
  EXPECT_TRUE(has_error(bad.diagnostics)) << bad.messages();
  options_.machine.startup_code.clear();
  options_.machine.axis_mask = 7;
  EXPECT_EQ(this->run("G0 A1\nM2\n").messages().rfind(part() + ":1: error: ", 0), 0U);
}

TEST_F(BridgeProgram, TheTextOfAnIniWithIncludesReachesTheInterpreter) {
  folder_.write("subs/far.ngc", "o<far> sub\nG0 X7\no<far> endsub\nM2\n");
  options_.machine.ini_path = folder_.write("mill.ini", "#INCLUDE paths.inc\n");
  EXPECT_TRUE(has_error(run("o<far> call\nM2\n").diagnostics)) << "not found without the path";
  options_.machine.ini_text = "[RS274NGC]\nSUBROUTINE_PATH = " + folder_.path("subs") + "\n";
  const ProgramRun found = run("o<far> call\nM2\n");
  EXPECT_EQ(found.messages(), "");
  EXPECT_EQ(found.motions.front().to_mm.x, 7);
}

TEST_F(BridgeProgram, ForeignOutputIsKept) {
  const ProgramRun run = this->run("(PRINT, hello)\nG0 X1\nM2\n");
  ASSERT_EQ(run.summary.foreign_lines.size(), 1U);
  EXPECT_EQ(run.summary.foreign_lines[0], " hello");
}

TEST_F(BridgeProgram, NeitherHomeNorToolTableOfARunningLinuxcncIsTouched) {
  const std::string home = folder_.path("home");
  std::filesystem::create_directory(home);
  const std::string mmap = folder_.write("home/.tool.mmap", std::string(1000, 'x'));
  const char* const before = std::getenv("HOME");
  const std::string kept = before != nullptr ? before : "";
  setenv("HOME", home.c_str(), 1);
  EXPECT_EQ(run("T1 M6\nG10 L1 P1 Z5\nG43\nG0 X1\n#<_kerf>=1\nM2\n").messages(), "");
  setenv("HOME", kept.c_str(), 1);
  EXPECT_EQ(text_of(mmap), std::string(1000, 'x'));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(home)) {
    (void)entry;
    ++files;
  }
  EXPECT_EQ(files, 1U);
}

TEST_F(BridgeProgram, FiftyPairsSideBySide) {
  options_.tool_table_path = folder_.write("tool.tbl", "T1 P1 D6 Z10\nT2 P2 D10 Z30\n");
  options_.path =
      folder_.write("part.ngc",
                    "T1 M6 G43\nG0 X0 Y0 Z9\nT2 M6 G43\nG0 X1 Z8\nG41 D2 G1 X20 F100\nG1 X40\nG40 "
                    "G0 X60\nM2\n");
  const ProgramRun alone = run_program(options_);
  EXPECT_EQ(alone.messages(), "");
  const auto same = [&](const ProgramRun& run) {
    bool equal = run.messages().empty() && run.motions.size() == alone.motions.size();
    for (std::size_t i = 0; equal && i < run.motions.size(); ++i) {
      equal = run.motions[i].to_mm == alone.motions[i].to_mm &&
              run.motions[i].tool == alone.motions[i].tool;
    }
    return equal;
  };
  int good = 0;
  for (int pair = 0; pair < 50; ++pair) {
    ProgramRun second;
    // The thread must outlive its child: it is waited for inside.
    std::thread other([&] { second = run_program(options_); });
    const ProgramRun first = run_program(options_);
    other.join();
    good += same(first) && same(second) ? 1 : 0;
  }
  EXPECT_EQ(good, 50);
}

TEST_F(BridgeProgram, AnInterpreterThatSaysNothingOrNonsense) {
  options_.kerf_interp_path = "/bin/true";
  EXPECT_EQ(run("G0 X1\nM2\n").messages(),
            part() +
                ": error: kerf-interp ended with status 0 in the middle\n   hint: --interp text "
                "uses rs274 instead\n");
  options_.kerf_interp_path = folder_.write("nonsense", "#!/bin/sh\necho kerfrec9 >&3\n");
  ASSERT_EQ(chmod(options_.kerf_interp_path.c_str(), 0755), 0);
  EXPECT_EQ(run("G0 X1\nM2\n").messages(),
            part() + ": error: the records of " + options_.kerf_interp_path +
                " cannot be read: it does not begin as the records of this version of kerf-interp "
                "do\n   hint: kerf and kerf-interp must be of one version\n");
  options_.kerf_interp_path = folder_.path("nix");
  EXPECT_FALSE(run("G0 X1\nM2\n").opened);
}

TEST_F(BridgeProgram, AProgramThatIsReplacedWhileItIsReadRunsAsItWas) {
  std::string text = "G21 G90 F1000\n";
  for (int i = 0; i < 200'000; ++i) text += "G1 X" + std::to_string(i % 100) + "\n";
  options_.path = folder_.write("part.ngc", text + "M2\n");
  Diagnostics diagnostics;
  const auto program = Program::open(options_, diagnostics);
  ASSERT_NE(program, nullptr);
  std::size_t moves = 0;
  const ProgramSummary summary = program->run(
      [&](std::span<const Motion> motions) {
        if (moves == 0) {
          // As an editor saves: another file takes the name.
          folder_.write("new.ngc", "G77\n");
          std::filesystem::rename(folder_.path("new.ngc"), part());
        }
        moves += motions.size();
        return true;
      },
      {}, diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_EQ(moves, 200'001U);
  EXPECT_TRUE(summary.has_program_end);
}

TEST_F(BridgeProgram, CompensationKeepsTheFileOfAMoveThatItHoldsBack) {
  folder_.write("arm.ngc", "o<arm> sub\n\n\n\n\n\n\n\n\nG1 Y20\nG1 X30\no<arm> endsub\nM2\n");
  const ProgramRun run = this->run(
      "G21 G90 F100\nG0 X0 Y0\nG41.1 D2\nG1 X10 Y0\nG1 X20\no<arm> call\nG1 X40\nG40\nG0 X50\n"
      "M2\n");
  EXPECT_FALSE(has_error(run.diagnostics)) << run.messages();
  std::vector<SourceRef> feeds;
  for (const Motion& motion : run.motions) {
    if (motion.kind == MotionKind::kFeed) feeds.push_back(motion.source);
  }
  EXPECT_EQ(feeds, (std::vector<SourceRef>{{0, 4}, {0, 5}, {1, 10}, {1, 11}, {0, 7}}));
}

TEST_F(BridgeProgram, TwoRemapsOfOneBlockAreInTheirOwnFiles) {
  folder_.write("first.ngc", "o<first> sub\nG0 X1\no<first> endsub\nM2\n");
  folder_.write("second.ngc", "o<second> sub\n\nG0 X2\no<second> endsub\nM2\n");
  options_.machine.ini_path =
      folder_.write("machine.ini",
                    "[RS274NGC]\nSUBROUTINE_PATH = .\nREMAP = M400 modalgroup=5 ngc=first\n"
                    "REMAP = M401 modalgroup=6 ngc=second\n");
  const ProgramRun run = this->run("G21\nM400 M401\nG0 X3\nM2\n");
  EXPECT_EQ(run.messages(), "");
  std::vector<SourceRef> moves;
  for (const Motion& motion : run.motions) {
    if (motion.kind == MotionKind::kTraverse) moves.push_back(motion.source);
  }
  EXPECT_EQ(moves, (std::vector<SourceRef>{{1, 2}, {2, 3}, {0, 3}}));
  EXPECT_EQ(run.summary.files.at(2), folder_.path("second.ngc"));
}

TEST_F(BridgeProgram, FaultsOfAnIniAreSaid) {
  const std::string ini =
      folder_.write("machine.ini", "[RS274NGC]\nREMAP = M400 modalgroup=5 ngc=nix\n");
  options_.machine.ini_path = ini;
  EXPECT_EQ(run("G0 X1\nM2\n").messages(),
            ini +
                ": error: INTERP_REMAP: NGC file not found: ngc=nix; REMAP INI Line:2 = M400 "
                "modalgroup=5 ngc=nix\n");
}

TEST_F(BridgeProgram, PythonRemapThatRaises) {
  folder_.write("top.py", "import remap\n");
  folder_.write("remap.py",
                "def m400(self, **words):\n    raise RuntimeError('no such luck')\n"
                "def m401(self, **words):\n    return 2\n");
  options_.machine.ini_path = folder_.write(
      "machine.ini",
      "[PYTHON]\nTOPLEVEL = top.py\nPATH_PREPEND = .\n[RS274NGC]\n"
      "REMAP = M400 modalgroup=5 python=m400\nREMAP = M401 modalgroup=5 python=m401\n");
  const ProgramRun raises = run("G21\nG0 X1\nM400\nM2\n");
  EXPECT_EQ(raises.motions.size(), 1U);
  EXPECT_EQ(raises.messages(),
            part() + ":3: error: pycall(m400):; Traceback (most recent call last):; File \"" +
                folder_.path("remap.py") +
                "\", line 2, in m400; raise RuntimeError('no such luck'); RuntimeError: no such "
                "luck\n     3 | M400\n");
  // Not a generator, as one that returns a number by mistake.
  const ProgramRun confused = run("G21\nG0 X1\nM401\nM2\n");
  ASSERT_EQ(confused.diagnostics.size(), 1U) << confused.messages();
  EXPECT_EQ(confused.diagnostics[0].file, part());
  EXPECT_EQ(confused.diagnostics[0].line, 3);
}

TEST_F(BridgeProgram, LogFileOfTheIniIsNotWritten) {
  const std::string log = folder_.write("machine.log", "of the running machine\n");
  options_.machine.ini_path = folder_.write(
      "machine.ini",
      "[EMC]\nDEBUG = 0x7fffffff\n[RS274NGC]\nLOG_LEVEL = 9\nLOG_FILE = " + log + "\n");
  EXPECT_EQ(run("G0 X1\nM2\n").messages(), "");
  EXPECT_EQ(text_of(log), "of the running machine\n");
  options_.machine.ini_path = folder_.write(
      "machine.ini", "[RS274NGC]\nLOG_LEVEL = 9\nLOG_FILE = " + folder_.path("none.log") + "\n");
  EXPECT_EQ(run("G0 X1\nM2\n").messages(), "");
  EXPECT_FALSE(std::filesystem::exists(folder_.path("none.log")));
}

TEST_F(BridgeProgram, RandomToolChangerSwapsPockets) {
  options_.machine.random_toolchanger = true;
  options_.machine.tool_lengths = true;
  // Pocket 0 is the spindle.
  options_.tool_table_path =
      folder_.write("tool.tbl", "T1 P1 D6 Z10\nT5 P0 D2 Z5\nT2 P2 D10 Z30\n");
  const ProgramRun run = this->run(
      "G21 G90\nG0 X#5403\nT1 M6\nG0 X#5403\nT2 M6\nG0 X#5403\nT5 M6\nG0 X#5403\nT1 M6\n"
      "G0 X#5403\nM2\n");
  EXPECT_EQ(run.messages(), "");
  std::vector<std::pair<int, double>> moves;
  for (const Motion& m : run.motions) {
    if (m.kind == MotionKind::kTraverse) moves.emplace_back(m.tool, m.to_mm.x);
  }
  const std::vector<std::pair<int, double>> expected = {{5, 5}, {1, 10}, {2, 30}, {5, 5}, {1, 10}};
  EXPECT_EQ(moves, expected);
}

TEST_F(BridgeProgram, ToolsAreChangedWhereTheMachineChangesThem) {
  options_.machine.tool_change_position = {3, 4, -2};
  options_.machine.tool_lengths = true;
  options_.machine.start = {0, 0, 100};
  options_.machine.start_known = true;
  options_.machine.parameter_path =
      folder_.write("mill.var", "5161\t0\n5220\t1\n5221\t12.5\n5222\t-7.25\n5223\t-60\n");
  options_.tool_table_path = folder_.write("tool.tbl", "T1 P1 D6 Z40\nT2 P2 D5 Z55.25\n");
  const ProgramRun run = this->run(
      "G21 G90 G54 G17 G64\nG92 X1\nG0 X10 Y10 Z5\nT1 M6 G43\nM3 S1000\nG1 X20 F600\nG0 Z20\n"
      "T2 M6\nG43\nG91 G0 X1\nG90 X30\nM5\nM2\n");
  EXPECT_EQ(run.messages(), "");
  // Where a real LinuxCNC 2.9 with the same INI, offsets and tools stood after each of its moves.
  const std::vector<std::pair<Vec3, double>> machine_mm = {
      {{9, 2.75, -55}, 0}, {{3, 4, -2}, 0},     {{19, 4, -2}, 40},   {{19, 4, 0}, 40},
      {{3, 4, -2}, 40},    {{4, 4, -2}, 55.25}, {{29, 4, -2}, 55.25}};
  std::vector<Motion> moves;
  for (const Motion& m : run.motions) {
    if (m.kind == MotionKind::kTraverse || m.kind == MotionKind::kFeed) moves.push_back(m);
  }
  ASSERT_EQ(moves.size(), machine_mm.size());
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const auto& [place, tool_length] = machine_mm[i];
    const Vec3 tip_mm = place - Vec3(-1, -7.25, -60 + tool_length);
    EXPECT_LT(glm::distance(moves[i].to_mm, tip_mm), 1e-9) << i;
    EXPECT_TRUE(moves[i].start_known) << i;
  }
  EXPECT_EQ(moves[1].source.line, 4U);
  EXPECT_EQ(moves[1].kind, MotionKind::kTraverse);

  // A and those behind it go along if they are said.
  options_.machine.tool_change_position = {3, 4, -2, 90, 0, 0};
  const ProgramRun turned = this->run("G21 G90\nG0 X0 A10\nT1 M6\nG0 X1\nM2\n");
  EXPECT_EQ(turned.messages(), "");
  ASSERT_GE(turned.motions.size(), 2U);
  EXPECT_EQ(turned.motions[1].to_abc_deg[0], 90);
}

TEST_F(BridgeProgram, ErrorOfASubroutineThatRunsNotOfItsText) {
  // Such an error unwinds the calls before it is told.
  const std::string sub = folder_.write("dry.ngc", "o<dry> sub\nG0 X2\nG1 X3\no<dry> endsub\nM2\n");
  EXPECT_EQ(
      run("G21\n\no<dry> call\nM2\n").messages(),
      sub + ":3: error: Cannot do g1 with zero feed rate\n     3 | G1 X3\n   hint: called from " +
          part() + ":3\n");
}

TEST_F(BridgeProgram, AProgramThatIsEditedWhileItIsReadIsSaid) {
  std::string text = "G21 G90 F1000\n";
  for (int i = 0; i < 200'000; ++i) text += "G1 X" + std::to_string(i % 100) + "\n";
  options_.path = folder_.write("part.ngc", text + "M2\n");
  Diagnostics diagnostics;
  const auto program = Program::open(options_, diagnostics);
  ASSERT_NE(program, nullptr);
  bool edited = false;
  program->run(
      [&](std::span<const Motion>) {
        if (!std::exchange(edited, true)) std::ofstream(part(), std::ios::app) << "G0 X7\n";
        return true;
      },
      {}, diagnostics);
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(to_string(diagnostics[0]),
            part() +
                ": error: the program was changed while it was read: this result is that of no "
                "program\n   hint: run it again\n");
}

}  // namespace
}  // namespace kerf
