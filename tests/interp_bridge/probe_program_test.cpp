// Probing moves: what kerf-interp asks, and what becomes of the answers.
#include <gtest/gtest.h>

#include <vector>

#include "interp_bridge/probe_branches.h"
#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

using Kind = ProbeAnswer::Kind;

class ProbeProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.interpreter = InterpreterChoice::kBridge;
    options_.kerf_interp_path = KERF_INTERP_EXECUTABLE;
  }
  /// Every question gets `answer`. Questions, and how many motions had come before each, are kept.
  ProgramRun run(const std::string& text, ProbeAnswer answer) {
    options_.path = folder_.write("part.ngc", text);
    ProgramRun run;
    const std::unique_ptr<Program> program = Program::open(options_, run.diagnostics);
    if (!program) return run;
    program->follow_probes([&](const ProbeQuestion& question) {
      questions_.push_back(question);
      before_.push_back(run.motions.size());
      return answer;
    });
    run.summary = program->run(
        [&](std::span<const Motion> batch) {
          run.motions.insert(run.motions.end(), batch.begin(), batch.end());
          return true;
        },
        {}, run.diagnostics);
    return run;
  }

  TestFolder folder_;
  ProgramOptions options_;
  std::vector<ProbeQuestion> questions_;
  std::vector<std::size_t> before_;
};

ProbeAnswer said(Kind kind) {
  ProbeAnswer answer;
  answer.kind = kind;
  return answer;
}
ProbeAnswer met(double share) { return {Kind::kMet, share, {}}; }

TEST_F(ProbeProgram, IsAskedWhenAllBeforeHasCome) {
  const ProgramRun run =
      this->run("G21 G90 F100\nG0 X1 Y2 Z5\nG0 Z4\nG38.2 Z-4\nG38.4 Z4\nM2\n", met(0.5));
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(questions_.size(), 2U);
  EXPECT_EQ(before_, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(questions_[0].motion.from_mm, Vec3(1, 2, 4));
  EXPECT_EQ(questions_[0].motion.to_mm, Vec3(1, 2, -4));
  EXPECT_FALSE(questions_[0].away);
  EXPECT_TRUE(questions_[1].away);
  EXPECT_EQ(questions_[1].motion.from_mm, Vec3(1, 2, 0)) << "it stands where it has tripped";
}

TEST_F(ProbeProgram, TheMoveEndsThereAndTheParametersFollow) {
  const ProgramRun run = this->run(
      "G20 G90 F10\nG0 X1 Y2 Z4\nG38.2 X2 Z-4\nG10 L20 P1 Z0\nG0 X#5061 Y#5062 Z[1+#5063]\n"
      "o1 if [#5070 NE 1]\nG0 X99\no1 endif\nM2\n",
      met(0.25));
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.motions.size(), 4U);
  EXPECT_EQ(run.motions[1].kind, MotionKind::kProbe);
  EXPECT_EQ(run.motions[1].to_mm, Vec3(1.25, 2, 2) * 25.4);
  // Z3 of a frame whose zero is where the probe stood, at Z2.
  EXPECT_NEAR(run.motions[2].to_mm.z, 5 * 25.4, 1e-9);
  EXPECT_TRUE(run.summary.notes.empty());
}

TEST_F(ProbeProgram, WhatItMustFindAndDoesNotIsTheMachinesError) {
  const ProgramRun run =
      this->run("G21 G90 F100\nG0 Z5\nG38.2 Z-4\nG0 X9\nM2\n", said(Kind::kMissed));
  ASSERT_EQ(run.diagnostics.size(), 1U);
  EXPECT_EQ(run.diagnostics[0].line, 3);
  EXPECT_EQ(run.diagnostics[0].message, "G38.2 move finished without making contact.");
  ASSERT_EQ(run.motions.size(), 2U) << "nothing behind it is run";
  EXPECT_EQ(run.motions[1].to_mm.z, -4);
  const ProgramRun away = this->run("G21 G90 F100\nG0 Z5\nG38.4 Z9\nM2\n", said(Kind::kMissed));
  ASSERT_EQ(away.diagnostics.size(), 1U);
  EXPECT_EQ(away.diagnostics[0].message, "G38.4 move finished without breaking contact.");
}

TEST_F(ProbeProgram, WhatItMayMissIsNoError) {
  const ProgramRun run =
      this->run("G21 G90 F100\nG0 Z5\nG38.3 Z-4\no1 if [#5070 EQ 0]\nG0 X7\no1 endif\nM2\n",
                said(Kind::kMissed));
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.motions.size(), 4U);
  EXPECT_EQ(run.motions[1].to_mm.z, -4);
  EXPECT_EQ(run.motions[2].to_mm.x, 7);
}

TEST_F(ProbeProgram, WhatIsSoAlreadyIsRefusedOrStandsStill) {
  const ProgramRun run = this->run("G21 G90 F100\nG0 Z5\nG38.2 Z-4\nM2\n", said(Kind::kRefused));
  ASSERT_EQ(run.diagnostics.size(), 1U);
  EXPECT_EQ(run.diagnostics[0].message,
            "Probe is already tripped when starting G38.2 or G38.3 move");
  const ProgramRun may =
      this->run("G21 G90 F100\nG0 Z5\nG38.5 Z9\nG0 X[#5070]\nM2\n", said(Kind::kRefused));
  EXPECT_EQ(may.messages(), "");
  ASSERT_EQ(may.motions.size(), 4U);
  EXPECT_EQ(may.motions[1].to_mm.z, 5);
  EXPECT_EQ(may.motions[2].to_mm, Vec3(1, 0, 5));
}

TEST_F(ProbeProgram, WhatHangsOnAnUnknownProbeIsNotKnown) {
  const ProgramRun run = this->run(
      "G21 G90 F100\nG0 X1 Z5\nG38.2 Z-4\nG10 L20 P1 Z0\nG0 Z9\nG10 L2 P1 Z[1]\nG0 X5\n"
      "G10 L2 P1 Z1\nG0 X6\nG0 Z8\nG0 X7\nM2\n",
      {Kind::kUnknown, 1, "of a reason"});
  EXPECT_EQ(run.messages(), "");
  ASSERT_EQ(run.summary.notes.size(), 1U);
  EXPECT_TRUE(run.summary.notes[0].is_sentence);
  EXPECT_NE(run.summary.notes[0].text.find("(of a reason)"), std::string::npos);
  for (const Motion& m : run.motions) {
    const std::uint32_t line = m.source.line;
    if (line < 5 || m.kind != MotionKind::kTraverse) continue;
    // By the number of line 8 the offset is known, and with line 10 where Z is.
    EXPECT_EQ(m.start_known, line > 10) << line;
  }
}

TEST(ProbeBranches, AreFoundByTheNamesOfParameters) {
  EXPECT_FALSE(branches_on_probe(""));
  EXPECT_FALSE(branches_on_probe("G38.2 Z-5\nG10 L2 P1 Z#5063\no1 if [#5070 EQ 0]\no1 endif\n"));
  EXPECT_FALSE(
      branches_on_probe("#1=0\no1 while [#1 LT 25]\n#<z>=#5063\n#1=[#1+1]\no1 endwhile\n"));
  EXPECT_FALSE(branches_on_probe("(#1=#5063)\no1 if [#1 GT 0] ; #5063\no1 endif\n"));
  EXPECT_TRUE(branches_on_probe("o1 if [ABS[# 5063-1] GT 0.01]\no1 endif\n"));
  EXPECT_TRUE(branches_on_probe("O<a> ELSEIF [#<z> GT 1]\n# <Z> = [#<y>*2]\n#<y>=#5061\n"));
  EXPECT_TRUE(branches_on_probe("#[#4+100]=#5063\no1 while [#[101] GT 0]\n"));
  EXPECT_TRUE(branches_on_probe("o<f> call [#5063]\no<f> sub\no1 if [#1 GT 0]\n"));
}

TEST_F(ProbeProgram, RsTextCannotAsk) {
  options_.interpreter = InterpreterChoice::kText;
  const ProgramRun run = this->run("G21 G90 F100\nG0 X1 Z5\nG38.2 Z-4\nG0 Z9\nM2\n", met(0.5));
  EXPECT_TRUE(questions_.empty());
  ASSERT_EQ(run.summary.notes.size(), 1U);
  EXPECT_EQ(run.summary.notes[0].source.line, 3U);
  ASSERT_EQ(run.motions.size(), 4U);
  EXPECT_FALSE(run.motions[2].start_known);
}

TEST_F(ProbeProgram, AStopEndsAProgramThatWaitsForNothingMore) {
  options_.path = folder_.write("part.ngc", "G21 F100\nG0 Z5\nG38.2 Z-4\nG0 Z5\nM2\n");
  Diagnostics diagnostics;
  const std::unique_ptr<Program> program = Program::open(options_, diagnostics);
  ASSERT_TRUE(program);
  program->follow_probes([](const ProbeQuestion&) { return met(0.5); });
  const ProgramSummary summary =
      program->run([](std::span<const Motion>) { return false; }, {}, diagnostics);
  EXPECT_TRUE(summary.stopped_early);
}

}  // namespace
}  // namespace kerf
