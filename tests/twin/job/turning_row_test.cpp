// Lathe tools of LinuxCNC's tool table.
#include "twin/job/turning_row.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "interp_bridge/tool_table.h"
#include "stock/cutter/insert_shape.h"
#include "stock/cutter/turning_hints.h"
#include "twin/job/tools.h"

namespace kerf {
namespace {

/// A table's only row, or the row of `tool`.
ToolTableRow row_of(std::string_view text, int tool = -1) {
  Diagnostics diagnostics;
  for (const ToolTableRow& row : parse_tool_table(text, "t.tbl", diagnostics)) {
    if (tool < 0 || row.tool == tool) return row;
  }
  ADD_FAILURE() << text;
  return {};
}

/// LinuxCNC 2.9's own sim/lathe.tbl, as an inch machine has it.
constexpr const char* kLinuxCncTable =
    "T1 P1 D0.100000 Z+0.100000 I+95.000000 J+155.000000 Q1 ;\n"
    "T2 P2 D0.100000 I+85.000000 J+25.000000 Q2 ;\n"
    "T3 P3 D0.100000 I+275.000000 J+335.000000 Q3 ;\n"
    "T4 P4 D0.100000 I+265.000000 J+205.000000 Q4 ;\n"
    "T5 P5 D0.100000 I+210.000000 J+150.000000 Q5 ;\n"
    "T6 P6 D0.100000 X+0.500000 Z+0.500000 I+120.000000 J+60.000000 Q6 ;\n"
    "T7 P7 D0.100000 I-30.000000 J+30.000000 Q7 ;\n"
    "T8 P8 D0.100000 I+240.000000 J+300.000000 Q8 ;\n"
    "T9 P9 D0.100000 Q9 ;\n"
    "T10 P10 D0. ; demo zero diameter\n";

TEST(TurningRow, LinuxCncsOwnTableIsTakenAsItIs) {
  const char* const wanted[] = {"turn:1.27:1:95:155",  "turn:1.27:2:85:25",   "turn:1.27:3:275:335",
                                "turn:1.27:4:265:205", "turn:1.27:5:210:150", "turn:1.27:6:120:60",
                                "turn:1.27:7:-30:30",  "turn:1.27:8:240:300", "turn:1.27:9"};
  for (int tool = 1; tool <= 9; ++tool) {
    ToolTableRow row = row_of(kLinuxCncTable, tool);
    row.diameter_mm *= 25.4;
    EXPECT_FALSE(turning_remark_shape(row)) << tool;
    const ShapeText text = turning_row_shape(row, false);
    EXPECT_EQ(text.shape, wanted[tool - 1]);
    EXPECT_FALSE(text.guessed) << text.guess;
    const Result<Cutter> cutter = parse_shape(text.shape);
    ASSERT_TRUE(cutter);
    EXPECT_EQ(cutter->insert_tip().orientation, tool);
    EXPECT_NEAR(cutter->insert_tip().nose_radius_mm, 1.27, 1e-12);
  }
}

TEST(TurningRow, WhatIsMissingIsNamed) {
  struct Case {
    const char* row;
    bool drills;
    const char* shape;
    const char* guess;
  };
  for (const Case& c :
       {Case{"T3 P3 D0.8 I85 J25", false, "turn:0.4:2:85:25",
             "Q (orientation) is missing in its row of the tool table, taken as 2"},
        Case{"T3 P3 D0.8 I275 J335", false, "turn:0.4:3:275:335",
             "Q (orientation) is missing in its row of the tool table, taken as 3"},
        Case{"T3 P3 D0.8 I95 J155", false, "turn:0.4:1:95:155", "taken as 1"},
        Case{"T3 P3 D0.8 I-30 J30", false, "turn:0.4:7:-30:30", "taken as 7"},
        Case{"T3 P3 D0.8 I240 J300", false, "turn:0.4:8:240:300", "taken as 8"},
        Case{"T5 P5 D0.1 I0 J0 Q6", false, "turn:0.05:6:120:60",
             "I and J (front and back angle) are missing in its row of the tool table, taken as "
             "120 and 60"},
        Case{"T5 P5 I85 J25 Q2", false, "turn:0:2:85:25",
             "D (twice the nose radius) is missing in its row of the tool table, taken for sharp"},
        Case{"T5 P5 D0.8 I85 J25 Q4", false, "turn:0.4:4:265:205",
             "I85 and J25 (front and back angle) do not lie behind a nose of orientation 4, taken "
             "as 265 and 205"},
        Case{"T5 P5 D0.8", false, "turn:0.4:2:85:25",
             "taken as 2; I and J (front and back angle) are missing"},
        Case{"T5 P5 D0.8", true, "drill:0.8:118", "it only goes straight down: taken for a drill"},
        Case{"T11 P11 D10", false, "drill:10:118", "10 mm are no nose: taken for a drill"}}) {
    const ShapeText text = turning_row_shape(row_of(c.row), c.drills);
    EXPECT_EQ(text.shape, c.shape) << c.row;
    EXPECT_TRUE(text.guessed) << c.row;
    EXPECT_NE(text.guess.find(c.guess), std::string::npos) << text.guess;
    EXPECT_TRUE(parse_shape(text.shape)) << text.shape;
  }
  // Their sound twins.
  for (const char* const row : {"T5 P5 D0 I85 J25 Q2", "T5 P5 D0.8 I0 J30 Q7", "T5 P5 D10 Q9",
                                "T5 P5 D10 I85 J25 Q2", "T7 P7 D0.8 I330 J30 Q7"}) {
    EXPECT_FALSE(turning_row_shape(row_of(row), true).guessed) << row;
  }
}

TEST(TurningRow, RemarksNameTools) {
  struct Case {
    const char* row;
    const char* shape;
    bool guessed;
  };
  for (const Case& c : {
           Case{"T1 P1 D0.8 Q2 ;iso:CNMG120408:R:95:holder=20x100",
                "iso:CNMG120408:R:95:holder=20x100", false},
           Case{"T1 P1 D0.8 I85 J5 Q2 ;CNMG 120408-PM rough", "iso:CNMG120408:R", false},
           Case{"T1 P1 D0.8 I95 J175 Q1 ;CNMG 120408", "iso:CNMG120408:L", false},
           Case{"T1 P1 D0.8 I75 J-5 Q2 ;finish DCMT 11T304", "iso:DCMT11T304:R:105", false},
           Case{"T1 P1 D0.4 I26 J86 Q2 ;TCMT110202 60 Grad", "iso:TCMT110202:R", true},
           Case{"T1 P1 D0.4 Q3 ;CCMT 21.51 boring", "iso:CCMT21.51:R:orient=3", false},
           Case{"T1 P1 ;VBMT 160404 left", "iso:VBMT160404:L", false},
           Case{"T1 P1 D0.2 Q6 ;groove 3mm", "groove:3:0.1:orient=6", false},
           Case{"T1 P1 D0.2 Q2 ;1/8\" parting", "part:3.175:0.1", false},
           Case{"T1 P1 Q4 ;Einstichstahl 2 mm", "groove:2:orient=4", false},
           Case{"T1 P1 Q7 ;face grooving 4mm", "facegroove:4:orient=7", false},
           Case{"T5 P5 D0.1 Q6 ;Einstichstahl", "groove:3:0.05:orient=6", true},
           Case{"T1 P1 ;part", "part:3", true},
           Case{"T1 P1 ;thread 60", "thread:60", false},
           Case{"T1 P1 Q8 ;threading tool 55 deg", "thread:55:orient=8", false},
           Case{"T1 P1 ;Innengewinde 60", "thread:60:orient=8", false},
           Case{"T1 P1 ;threading tool", "thread:60", true},
           Case{"T1 P1 D0.4 I275 J355 Q3 ;boring bar 12mm", "bore:0.2:12::275:355", false},
           Case{"T1 P1 D0.4 I275 J335 Q3 ;boring bar", "turn:0.2:3:275:335", false},
           Case{"T1 P1 D0.4 ;boring bar", "turn:0.2:3:275:335", true},
           Case{"T1 P1 ;drill 8mm", "drill:8:118", false},
           Case{"T1 P1 D8.5 ;Bohrer", "drill:8.5:118", false},
           Case{"T1 P1 D5 ;5 mm end mill", "flat:5", false},
       }) {
    const ToolTableRow row = row_of(c.row);
    const std::optional<ShapeText> text = turning_remark_shape(row);
    ASSERT_TRUE(text) << c.row;
    EXPECT_EQ(text->shape, c.shape) << c.row;
    EXPECT_EQ(text->guessed, c.guessed) << c.row << text->guess;
    EXPECT_EQ(text->guessed, !text->guess.empty()) << c.row;
    EXPECT_TRUE(parse_shape(text->shape)) << text->shape;
  }
  for (const char* const row :
       {"T1 P1 Q2 ;face", "T1 P1 Q2 ;turn", "T1 P1 Q2 ;60 Grad vorn", "T1 P1 ;No Tool",
        "T10 P10 D0. ; demo zero diameter", "T1 P1 Q2 ;roughing 80 deg", "T1 P1 ;Wear Offset 1"}) {
    EXPECT_FALSE(turning_remark_shape(row_of(row))) << row;
  }
}

ToolSources turning_sources(std::string_view table) {
  ToolSources sources;
  Diagnostics diagnostics;
  sources.table = parse_tool_table(table, "t.tbl", diagnostics);
  sources.turning = true;
  return sources;
}

TEST(TurningTools, RowsAreLatheToolsWhereTheWorkpieceTurns) {
  ToolSources sources = turning_sources(
      "T1 P1 D0.8 I85 J25 Q2 ;face\nT2 P2 D0.4 I85 J25\nT3 P3 D0.4 Q2 ;iso:CNMG120408:X\n");
  ToolResolver resolver(sources, nullptr);
  const ResolvedTool& first = resolver.mount(1, 1);
  ASSERT_TRUE(first.cutter);
  EXPECT_EQ(first.cutter->spec(), "turn:0.4:2:85:25");
  EXPECT_FALSE(first.guessed);
  EXPECT_EQ(first.origin, "line 1 of the tool table");
  const ResolvedTool& second = resolver.mount(2, 2);
  EXPECT_TRUE(second.guessed);
  EXPECT_FALSE(second.is_size_alone());
  // A SHAPE that is wrong is no tool, and is not replaced by the row in silence.
  const ResolvedTool& third = resolver.mount(3, 3);
  EXPECT_FALSE(third.cutter);
  EXPECT_NE(third.trouble.find("line 3 of the tool table: iso:CNMG120408:X: hand HAND: 'X'"),
            std::string::npos)
      << third.trouble;
  EXPECT_FALSE(resolver.mount(4, 4).cutter);

  sources.turning = false;
  ToolResolver mill(sources, nullptr);
  EXPECT_EQ(mill.mount(1, 1).cutter->spec(), "flat:0.8");
}

TEST(TurningTools, CommentsWithADiameterAloneComeAfterTheTable) {
  ToolSources sources = turning_sources("T1 P1 D0.8 I85 J25 Q2\nT2 P2 D0.8 I85 J25 Q2\n");
  ToolHint size, whole;
  size.tool = 1;
  size.shape = "flat:0.8";
  size.shape_guessed = true;
  whole.tool = 2;
  whole.shape = "iso:CNMG120408";
  sources.hints = {size};
  sources.turning_hints = {whole};
  ToolResolver resolver(sources, nullptr);
  EXPECT_EQ(resolver.mount(1, 1).cutter->spec(), "turn:0.4:2:85:25");
  EXPECT_EQ(resolver.mount(2, 2).cutter->spec(), "iso:CNMG120408");
  const std::map<int, KnownDiameter> known = known_diameters(sources);
  EXPECT_NEAR(known.at(2).mm, 1.6, 1e-12);
  EXPECT_EQ(known.at(2).orientation, 2);
  // On a mill such a comment says nothing.
  sources.turning = false;
  EXPECT_EQ(known_diameters(sources).count(2), 0u);
  ToolResolver mill(sources, nullptr);
  EXPECT_EQ(mill.mount(2, 2).cutter->spec(), "flat:0.8");
}

std::vector<ToolHint> hints_of(std::vector<CommentText> comments) {
  std::uint32_t line = 0;
  for (CommentText& comment : comments) comment.line = ++line;
  return find_turning_hints(comments);
}

TEST(TurningHints, CommentsAboutATool) {
  CommentText block;
  block.text = "DNMG 150608 finish";
  block.block_tool = 4;
  CommentText list, named, loose, tiny;
  list.text = "T01 - CNMG 432 OD rough";
  named.text = "TOOL 2: groove 3mm";
  loose.text = "insert: WNMG080408";
  loose.at_change = false;
  tiny.text = "T3 = 1/8 parting";
  tiny.inches = true;
  const std::vector<ToolHint> hints = hints_of({list, named, tiny, block, loose});
  ASSERT_EQ(hints.size(), 5u);
  EXPECT_EQ(hints[0].tool, 1);
  EXPECT_EQ(hints[0].shape, "iso:CNMG432:R");
  EXPECT_EQ(hints[1].tool, 2);
  EXPECT_EQ(hints[1].shape, "groove:3");
  EXPECT_EQ(hints[2].shape, "part:3.175");
  EXPECT_EQ(hints[3].tool, 4);
  EXPECT_EQ(hints[3].shape, "iso:DNMG150608:R");
  EXPECT_EQ(hints[4].tool, -1);
  EXPECT_TRUE(hints[4].near);
}

TEST(TurningHints, TheTableSaysWhatTheyLeaveOut) {
  Diagnostics diagnostics;
  const std::map<int, TurningFacts> rows =
      turning_facts(parse_tool_table("T1 P1 D0.8 I275 J355 Q3\nT4 P4 Q8\n", "t.tbl", diagnostics));
  CommentText insert, thread, other;
  insert.text = "T1 - CCMT 09T308";
  thread.text = "T4: threading tool 60";
  other.text = "T5 - CCMT 09T308";
  const std::vector<CommentText> comments{insert, thread, other};
  const std::vector<ToolHint> hints = find_turning_hints(comments, rows);
  ASSERT_EQ(hints.size(), 3u);
  EXPECT_EQ(hints[0].shape, "iso:CCMT09T308:R:orient=3");
  EXPECT_EQ(hints[1].shape, "thread:60:orient=8");
  EXPECT_EQ(hints[2].shape, "iso:CCMT09T308:R");
}

TEST(TurningHints, InsertsWithoutASizeAreGuessed) {
  const auto shape = [](const char* text, int block_tool = -1) {
    CommentText comment;
    comment.text = text;
    comment.block_tool = block_tool;
    const std::vector<ToolHint> hints = hints_of({comment});
    if (hints.size() != 1) return std::string();
    EXPECT_TRUE(hints[0].shape_guessed) << text;
    EXPECT_NE(hints[0].guess.find("size"), std::string::npos) << hints[0].guess;
    return std::to_string(hints[0].tool) + " " + hints[0].shape;
  };
  EXPECT_EQ(shape("Step 3: face | T1: DCMT Aussendrehen"), "1 iso:DCMT11T304:R");
  EXPECT_EQ(shape("T2: CCMT Innendrehen"), "2 iso:CCMT09T304:R:orient=3");
  EXPECT_EQ(shape("vcmt", 11), "11 iso:VCMT160404:R");
  EXPECT_EQ(shape("T3 - WNMG left"), "3 iso:WNMG080408:L");
  EXPECT_EQ(shape("DCMT Aussendrehen"), "") << "of no tool";
  EXPECT_EQ(shape("T1: DCMT 99 finish"), "") << "there is no such size";
  EXPECT_EQ(shape("T1: WCMT"), "");
  EXPECT_EQ(shape("T1: come down then stop"), "");
}

TEST(TurningHints, TheTableSaysMoreThanAnInsertWithoutASize) {
  EXPECT_FALSE(turning_remark_shape(row_of("T1 P1 D0.8 I85 J25 Q2 ;DCMT finish\n")));
  const std::optional<ShapeText> bare = turning_remark_shape(row_of("T1 P1 Q3 ;DCMT finish\n"));
  ASSERT_TRUE(bare);
  EXPECT_EQ(bare->shape, "iso:DCMT11T304:R:orient=3");
  EXPECT_TRUE(bare->guessed);
}

TEST(TurningHints, WordsAboutTheWorkAreNone) {
  for (const char* const text :
       {"t1 is for facing and left turning, t4 is threading tool, t9 parting", "thread M20x1.5",
        "groove 3 deep", "part off", "drill 8mm", "face", "T1 rough", "proper tool offsets"}) {
    CommentText comment;
    comment.text = text;
    EXPECT_TRUE(hints_of({comment}).empty()) << text;
  }
}

TEST(TurningTools, CommentsOfLathesCountOnLathesAlone) {
  ToolSources sources;
  ToolHint mill, turning;
  mill.tool = turning.tool = 1;
  mill.line = turning.line = 3;
  mill.shape = "flat:0.8";
  turning.shape = "iso:CNMG120408";
  sources.hints = {mill};
  sources.turning_hints = {turning};
  ToolResolver on_mill(sources, nullptr);
  EXPECT_EQ(on_mill.mount(1, 5).cutter->spec(), "flat:0.8");
  sources.turning = true;
  ToolResolver on_lathe(sources, nullptr);
  EXPECT_EQ(on_lathe.mount(1, 5).cutter->spec(), "iso:CNMG120408");
  EXPECT_FALSE(on_lathe.mount(1, 5).guessed);
}

TEST(TurningTools, TurningToolsDoNotMill) {
  ToolSources sources;
  sources.arguments.push_back(std::move(parse_tool_argument("1=iso:CNMG120408").value()));
  ToolResolver mill(sources, nullptr);
  EXPECT_FALSE(mill.mount(1, 1).cutter);
  EXPECT_NE(mill.mount(1, 1).trouble.find("iso:CNMG120408 is a turning tool"), std::string::npos);
  sources.turning = true;
  ToolResolver lathe(sources, nullptr);
  EXPECT_TRUE(lathe.mount(1, 1).cutter);
}

TEST(TurningTools, TheInterpreterIsGivenNoseAndOrientation) {
  ToolSources sources = turning_sources("T1 P1 Z1 Q2\n");
  for (const char* const text : {"1=iso:CNMG120404", "7=turn:0.2:3:275:335", "8=drill:8:118"})
    sources.arguments.push_back(std::move(parse_tool_argument(text).value()));
  ToolDiameters told;
  const std::vector<ToolTableRow> rows =
      with_known_diameters(sources.table, true, known_diameters(sources), told);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[0].diameter_mm, 0.8, 1e-12);
  EXPECT_EQ(rows[0].orientation, 2);
  EXPECT_NEAR(rows[1].diameter_mm, 0.4, 1e-12);
  EXPECT_EQ(rows[1].orientation, 3);
  EXPECT_NEAR(rows[2].diameter_mm, 8, 1e-12);
  EXPECT_EQ(rows[2].orientation, 0);
}

}  // namespace
}  // namespace kerf
