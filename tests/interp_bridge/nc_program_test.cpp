// NC programs through the installed rs274.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <set>
#include <thread>

#include "interp_bridge/interpreter_process.h"
#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

class NcProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_NE(find_executable("rs274"), "") << "install linuxcnc-uspace";
    options_.interpreter = InterpreterChoice::kText;
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

TEST_F(NcProgram, MotionsCarryTheirLines) {
  const ProgramRun run =
      this->run("G21 G90\n\n(comment)\nG0 X1 Y2 Z3\nN900 G1 X10 F300\nG2 X20 I5\nM2\n");
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.motions.size(), 4u);
  EXPECT_EQ(lines_of(run.motions), (std::vector<std::uint32_t>{4, 5, 6, 7}));
  EXPECT_FALSE(run.motions[0].start_known);
  EXPECT_EQ(run.motions[1].to_mm, Vec3(10, 2, 3));
  EXPECT_EQ(run.motions[2].kind, MotionKind::kArc);
  EXPECT_NEAR(run.motions[2].arc.sweep_rad, -kPi, 1e-9);
  EXPECT_EQ(run.motions[3].kind, MotionKind::kProgramEnd);
  EXPECT_EQ(run.summary.interpreter, "text");
  EXPECT_EQ(run.summary.program_lines, 7u);
  EXPECT_TRUE(run.summary.has_program_end);
  EXPECT_FALSE(run.summary.stopped_early);
  EXPECT_GT(run.summary.interpret_s, 0);
}

TEST_F(NcProgram, BlockDelete) {
  const std::string text = "G21\n/G0 X1\n/N5 G0 X2\nG0 X3\nM2\n";
  EXPECT_EQ(lines_of(run(text).motions), (std::vector<std::uint32_t>{4, 5}));
  options_.block_delete = false;
  EXPECT_EQ(lines_of(run(text).motions), (std::vector<std::uint32_t>{2, 3, 4, 5}));
}

TEST_F(NcProgram, SubroutineInAnotherFile) {
  folder_.write("hole.ngc",
                "o<hole> sub\n(drill)\nG1 Z[-#1] F100\no<deeper> call\nG0 Z5\no<hole> endsub\n");
  folder_.write("deeper.ngc", "o<deeper> sub\nG1 Z-9\no<deeper> endsub\n");
  const ProgramRun run = this->run("G21\nG0 Z5\no<hole> call [3]\nM2\n");
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.summary.files.size(), 3u);
  EXPECT_EQ(run.summary.files[1], folder_.path("hole.ngc"));
  ASSERT_EQ(run.motions.size(), 5u);
  EXPECT_EQ(run.motions[1].source, (SourceRef{1, 3}));
  EXPECT_EQ(run.motions[1].to_mm.z, -3);
  EXPECT_EQ(run.motions[2].source, (SourceRef{2, 2}));
  EXPECT_EQ(run.motions[3].source, (SourceRef{1, 5}));
}

TEST_F(NcProgram, FanucSubroutineInAnotherFile) {
  folder_.write("8.ngc", "O8\nG0 X5\nM99\n");
  const ProgramRun run = this->run("G21\nM98 P8\nM2\n");
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.motions.size(), 2u);
  EXPECT_EQ(run.motions[0].source, (SourceRef{1, 2}));
}

constexpr const char* kNoSuchCode =
    "   hint: LinuxCNC has no such code and stops here, too, but where an INI remaps it (--ini)\n";

TEST_F(NcProgram, ErrorsNameFileAndLine) {
  EXPECT_EQ(run("G21\nN70 G0 X1\n  N80 G0 X1 X2 (twice)\nM2\n").messages(),
            part() + ":3: error: Multiple x words on one line\n     3 |   N80 G0 X1 X2 (twice)\n");
  EXPECT_EQ(run("G21\nG0 X1\nM77\nM2\n").messages(),
            part() + ":3: error: Unknown m code used: M77\n     3 | M77\n" + kNoSuchCode);
  EXPECT_EQ(run("G21\r\n\r\nG1 X1\r\nM2\r\n").messages(),
            part() + ":3: error: Cannot do g1 with zero feed rate\n     3 | G1 X1\n");
}

TEST_F(NcProgram, ErrorInASubroutineNamesItsFile) {
  const std::string sub = folder_.write("bad.ngc", "o<bad> sub\nG0 X1\nG99.9\no<bad> endsub\n");
  const ProgramRun run = this->run("G21\no<bad> call\nM2\n");
  EXPECT_EQ(run.messages(), sub + ":3: error: Unknown g code used\n     3 | G99.9\n" + kNoSuchCode);
  EXPECT_EQ(run.motions.size(), 1u) << "what came before the error";
}

TEST_F(NcProgram, MissingSubroutine) {
  EXPECT_EQ(
      run("G21\no<nosuch> call\nM2\n").messages(),
      part() +
          ":2: error: EOF in file:part.ngc seeking o-word: o<nosuch> from line: 2\n"
          "     2 | o<nosuch> call\n"
          "   hint: a subroutine that the program calls must be in it, or in NAME.ngc beside it\n");
}

TEST_F(NcProgram, LineTooLongForLinuxcnc) {
  const std::string line = "G0 X1 (" + std::string(260, 'a') + ")";
  const ProgramRun run = this->run("G21\n" + line + "\nM2\n");
  ASSERT_EQ(run.diagnostics.size(), 1u);
  EXPECT_EQ(run.diagnostics[0].message, "Command too long");
  EXPECT_EQ(run.diagnostics[0].line, 2);
}

TEST_F(NcProgram, LineTooLongForANumberStillHasOne) {
  const std::string line = "G0 X2 (" + std::string(242, 'a') + ")";  // 250 bytes and its number
  const ProgramRun run = this->run(std::string(9, '\n') + "G0 X1\n" + line + "\nG0 X3\nM2\n");
  EXPECT_EQ(run.messages(), "");
  EXPECT_EQ(lines_of(run.motions), (std::vector<std::uint32_t>{10, 11, 12, 13}));
}

TEST_F(NcProgram, MissingProgramEndIsAWarning) {
  const ProgramRun run = this->run("G21\nG0 X1\nG0 X2\n");
  EXPECT_EQ(
      run.messages(),
      part() +
          ":3: warning: the program has no end: File ended with no percent sign or program end\n"
          "   hint: end it with M2 or M30, or put it between two lines of %\n");
  EXPECT_FALSE(run.summary.has_program_end);
  EXPECT_EQ(run.motions.size(), 2u);
}

TEST_F(NcProgram, PercentIsAProgramEnd) {
  const ProgramRun run = this->run("%\nG21\nG0 X1\n%\n");
  EXPECT_EQ(run.messages(), "");
  EXPECT_TRUE(run.summary.has_program_end);
}

TEST_F(NcProgram, ToolDiameterReachesCutterCompensationInMm) {
  options_.tool_table_path = folder_.write("tool.tbl", "T9 P9 D99\nT1 P1 D6 Z10 ;ball\n");
  // Outside corner of a square at radius 3: the trap is a table taken for inches (radius 76.2).
  const ProgramRun run = this->run(
      "G21 G90 G17\nT1 M6 G43\nG0 X0 Y0 Z0\nF100\nG41 D1\nG1 X20 Y20\nX40\nY60\nX20\nG40 X0 "
      "Y0\nM2\n");
  EXPECT_EQ(run.messages(), "");
  bool found = false;
  for (const Motion& motion : run.motions) {
    found |= motion.kind == MotionKind::kFeed && motion.to_mm == Vec3(37, 23, 0);
    EXPECT_TRUE(motion.kind == MotionKind::kToolChange || motion.tool == 1);
    EXPECT_EQ(motion.to_mm.z, 0) << "a length offset of the table does not move the tip";
  }
  EXPECT_TRUE(found);
}

TEST_F(NcProgram, CompensationWithoutATableIsSaid) {
  const ProgramRun run = this->run("G21\nT1 M6\nF100\nG41 D1\nG1 X20 Y20\nX40\nG40 X60\nM2\n");
  ASSERT_EQ(run.diagnostics.size(), 1u);
  EXPECT_EQ(run.diagnostics[0].line, 4);
  EXPECT_EQ(run.diagnostics[0].message,
            "cutter radius compensation (G41, G42) without a tool table: the radius counts as 0");
}

TEST_F(NcProgram, ToolsWithoutATable) {
  const ProgramRun run = this->run("G21\nT77 M6\nG43 H78\nG0 X1\nM61 Q12\nT0 M6\nM2\n");
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.motions.size(), 5u);
  EXPECT_EQ(run.motions[0].tool, 77);
  EXPECT_EQ(run.motions[2].tool, 12) << "M61 prints a row of the table";
  EXPECT_EQ(run.motions[3].tool, 0);
}

TEST_F(NcProgram, NoPhantomHeightAfterAToolChange) {
  options_.tool_table_path = folder_.write("tool.tbl", "T1 P1 D6 Z10\nT2 P2 D8 Z20\n");
  const ProgramRun run =
      this->run("G21\nT1 M6\nG0 X0 Y0 Z100\nG43 H1\nT2 M6\nG0 X10\nG43 H2\nG0 X20\nM2\n");
  // The machine stays at Z100: the tip is below that by the length of the tool in the spindle,
  // whatever offset is in force.
  std::vector<double> tips;
  for (const Motion& motion : run.motions) {
    if (motion.kind == MotionKind::kTraverse) tips.push_back(motion.to_mm.z);
  }
  EXPECT_EQ(tips, (std::vector<double>{90, 80, 80}));
}

TEST_F(NcProgram, ForeignOutputIsKept) {
  const ProgramRun run = this->run("G21\n(PRINT,hello #5400)\nG0 X1\n(MSG, shown)\nM2\n");
  EXPECT_EQ(run.messages(), "");
  EXPECT_EQ(run.summary.foreign_lines, std::vector<std::string>{"hello 0.000000"});
  EXPECT_EQ(run.summary.canonical_commands.at("MESSAGE"), 1u);
}

TEST_F(NcProgram, MuchForeignOutputDoesNotBlock) {
  const ProgramRun run = this->run(
      "G21\n#1=0\no1 while [#1 lt 4000]\n(PRINT,a text of some length to fill the pipe: "
      "#1)\n#1=[#1+1]\no1 "
      "endwhile\nM2\n");
  EXPECT_EQ(run.messages(), "");
  EXPECT_EQ(run.summary.foreign_line_count, 4000u);
  EXPECT_EQ(run.summary.foreign_lines.size(), 100u);
}

TEST_F(NcProgram, SplinesAreReportedAsLost) {
  const ProgramRun run =
      this->run("G21\nF100\nG0 X0 Y0\nG5 X30 Y10 I3 J2 P-3 Q-2\nG1 X40\nG1 X50\nM2\n");
  ASSERT_EQ(run.diagnostics.size(), 1u);
  EXPECT_EQ(run.diagnostics[0].line, 4);
  EXPECT_FALSE(run.motions[1].start_known);
  EXPECT_TRUE(run.motions[2].start_known);
}

TEST_F(NcProgram, EndlessProgramWithMotions) {
  options_.max_commands = 100'000;
  const ProgramRun run = this->run("G21\nF100\no1 while [1]\nG1 X1\nG1 X0\no1 endwhile\nM2\n");
  ASSERT_EQ(run.diagnostics.size(), 1u);
  EXPECT_EQ(run.diagnostics[0].message,
            "more than 100000 canonical commands; the program counts as endless");
  EXPECT_GE(run.diagnostics[0].line, 4);
  EXPECT_LE(run.diagnostics[0].line, 5);
  EXPECT_TRUE(run.summary.stopped_early);
}

TEST_F(NcProgram, EndlessProgramWithoutMotions) {
  options_.max_silent_s = 0.5;
  const ProgramRun run = this->run("G21\nG0 X1\n#1=0\no1 while [1]\n#1=[#1+1]\no1 endwhile\nM2\n");
  ASSERT_EQ(run.diagnostics.size(), 1u);
  EXPECT_EQ(run.diagnostics[0].severity, Severity::kError);
  EXPECT_EQ(run.diagnostics[0].line, 2) << "the last line that did something";
  EXPECT_NE(run.diagnostics[0].message.find("for 0.5 s; the program counts as endless"),
            std::string::npos);
  EXPECT_TRUE(run.summary.stopped_early);
}

TEST_F(NcProgram, SilentLoopInALongProgramSaysHowFarItWasRead) {
  options_.max_silent_s = 0.5;
  std::string text = "G21\n#1=0\no1 while [1]\n#1=[#1+1]\no1 endwhile\n";
  for (int i = 0; i < 20'000; ++i) text += "G1 X1 Y1\n";
  const ProgramRun run = this->run(text + "M2\n");
  ASSERT_EQ(run.diagnostics.size(), 1u);
  EXPECT_NE(run.diagnostics[0].message.find("rs274 has read up to line"), std::string::npos);
}

TEST_F(NcProgram, ConsumerStopsEarly) {
  options_.path =
      folder_.write("part.ngc", "G21\nF100\no1 while [1]\nG1 X1\nG1 X0\no1 endwhile\nM2\n");
  Diagnostics diagnostics;
  const auto program = Program::open(options_, diagnostics);
  ASSERT_NE(program, nullptr);
  int calls = 0;
  const ProgramSummary summary = program->run(
      [&](std::span<const Motion> batch) {
        EXPECT_FALSE(batch.empty());
        return ++calls < 3;
      },
      {}, diagnostics);
  EXPECT_EQ(calls, 3);
  EXPECT_TRUE(summary.stopped_early);
  EXPECT_TRUE(diagnostics.empty());
}

TEST_F(NcProgram, StopTokenEndsASilentLoop) {
  options_.path = folder_.write("part.ngc", "G21\nG0 X1\no1 while [1]\n#1=1\no1 endwhile\nM2\n");
  Diagnostics diagnostics;
  const auto program = Program::open(options_, diagnostics);
  std::stop_source stop;
  const auto begin = std::chrono::steady_clock::now();
  std::jthread stopper([&](const std::stop_token& test_ends) {
    // Once the private folder is there, so is the child, or it comes.
    while (folder_.nothing_left_behind() && !test_ends.stop_requested()) std::this_thread::yield();
    stop.request_stop();
  });
  const ProgramSummary summary =
      program->run([](std::span<const Motion>) { return true; }, stop.get_token(), diagnostics);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(took.count(), options_.max_silent_s);
  EXPECT_TRUE(summary.stopped_early);
  EXPECT_TRUE(diagnostics.empty());
}

TEST_F(NcProgram, InterpreterKilledBySignal) {
  const std::string script = folder_.write("fake-rs274", "#!/bin/sh\nkill -SEGV $$\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  options_.rs274_path = script;
  const ProgramRun run = this->run("G0 X1\nM2\n");
  EXPECT_EQ(run.messages(),
            part() + ": error: rs274 was ended by signal 11 (Segmentation fault)\n");
}

TEST_F(NcProgram, InterpreterThatCannotStart) {
  const std::string script = folder_.write("fake-rs274", "#!/no/such/shell\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  options_.rs274_path = script;
  EXPECT_EQ(run("G0 X1\nM2\n").messages(),
            part() + ": error: cannot start " + script + ": No such file or directory\n");
}

TEST_F(NcProgram, HomeIsNotTouched) {
  const std::string old_home = getenv("HOME") != nullptr ? getenv("HOME") : "";
  const std::string live = folder_.write("home/.tool.mmap", "the table of a running LinuxCNC");
  setenv("HOME", folder_.path("home").c_str(), 1);
  EXPECT_EQ(run("G21\nT1 M6\nG0 X1\nM2\n").messages(), "");
  setenv("HOME", old_home.c_str(), 1);
  EXPECT_EQ(text_of(live), "the table of a running LinuxCNC");
}

TEST_F(NcProgram, OpenFilesDoNotReachTheChild) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);  // not close-on-exec
  const std::string script = folder_.write("fake-rs274", "#!/bin/sh\nls /proc/self/fd | wc -l\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  options_.rs274_path = script;
  // 0, 1, 2, the listing's pipe, and the folder that ls reads.
  EXPECT_EQ(run("M2\n").summary.foreign_lines, std::vector<std::string>{"5"});
  close(ends[0]);
  close(ends[1]);
}

TEST_F(NcProgram, Progress) {
  std::string text = "G21\nF100\n";
  for (int i = 0; i < 20'000; ++i) text += "G1 X" + std::to_string(i) + "\n";
  options_.path = folder_.write("part.ngc", text + "M2\n");
  Diagnostics diagnostics;
  const auto program = Program::open(options_, diagnostics);
  EXPECT_EQ(program->progress(), 0);
  std::set<double> seen;
  program->run(
      [&](std::span<const Motion>) {
        seen.insert(program->progress());
        return true;
      },
      {}, diagnostics);
  EXPECT_EQ(program->progress(), 1);
  EXPECT_GT(seen.size(), 2u);
}

TEST_F(NcProgram, NameThatLooksLikeAnOption) {
  options_.path = folder_.write("-b", "G0 X1\nM2\n");
  const ProgramRun run = run_program(options_);
  EXPECT_EQ(run.messages(), "");
  EXPECT_EQ(run.motions.size(), 2u);
}

}  // namespace
}  // namespace kerf
