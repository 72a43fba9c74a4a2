#include "interp_bridge/tool_table.h"

#include <gtest/gtest.h>

#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

struct Parsed {
  Diagnostics diagnostics;
  std::vector<ToolTableRow> rows;

  explicit Parsed(std::string_view text) : rows(parse_tool_table(text, "t.tbl", diagnostics)) {}
  std::string messages() const {
    std::string text;
    for (const Diagnostic& one : diagnostics) {
      text += std::to_string(one.line) + ":" + std::to_string(one.column) + ": " +
              kerf::to_string(one.severity) + ": " + one.message + "\n";
    }
    return text;
  }
};

TEST(ToolTable, RowsInAnyOrderAndCase) {
  const Parsed parsed(
      ";comment only\n"
      "T1   P2  D6      Z+50.0   ;6 mm ball endmill\n"
      "  d1e1 p4 t3 x1. y.5 z-9 I95 J155 Q6 A1 B2 C3 U4 V5 W6;full\r\n"
      "\n"
      "T0 P0 D3");
  EXPECT_EQ(parsed.messages(), "");
  ASSERT_EQ(parsed.rows.size(), 3u);
  EXPECT_EQ(parsed.rows[0].tool, 1);
  EXPECT_EQ(parsed.rows[0].pocket, 2);
  EXPECT_EQ(parsed.rows[0].diameter_mm, 6);
  EXPECT_EQ(parsed.rows[0].offset_mm, Vec3(0, 0, 50));
  EXPECT_EQ(parsed.rows[0].remark, "6 mm ball endmill");
  EXPECT_EQ(parsed.rows[0].line, 2);
  EXPECT_EQ(parsed.rows[1].diameter_mm, 10);
  EXPECT_EQ(parsed.rows[1].offset_mm, Vec3(1, 0.5, -9));
  EXPECT_EQ(parsed.rows[1].orientation, 6);
  EXPECT_EQ(parsed.rows[1].back_angle_deg, 155);
  EXPECT_EQ(parsed.rows[1].remark, "full");
}

TEST(ToolTable, BadRowsSayWhere) {
  const Parsed parsed(
      "T7 P7 D12 K3\n"
      "T16 P16 D 19\n"
      "T15 P15 Dfoo\n"
      "T6 D11\n"
      "P6 D11\n"
      "T-5 P18\n"
      "T1 P1 D1 D2\n"
      "T2 P2 D1.2.3\n"
      "T2 P2 Dinf\n"
      "T2 P2 Q12\n");
  EXPECT_TRUE(parsed.rows.empty());
  EXPECT_EQ(parsed.messages(),
            "1:11: error: unknown word K; the row is skipped\n"
            "2:10: error: D has no value; the row is skipped\n"
            "3:10: error: Dfoo: not a number; the row is skipped\n"
            "4:1: error: the row has no P word; it is skipped\n"
            "5:1: error: the row has no T word; it is skipped\n"
            "6:2: error: tool number -5; must be a whole number from 0 to 99999\n"
            "7:10: error: D stands twice; the row is skipped\n"
            "8:8: error: D1.2.3: not a number; the row is skipped\n"
            "9:8: error: Dinf: not a number; the row is skipped\n"
            "10:8: error: orientation 12; must be a whole number from 0 to 9\n");
}

TEST(ToolTable, AcceptedWithAWarning) {
  const Parsed parsed(
      "T2\tP2\tD7 ;tabs\n"
      "T4 P4 D9 \r\n"
      "T4 P5 D8\n");
  EXPECT_EQ(parsed.rows.size(), 2u);
  EXPECT_EQ(parsed.rows[0].diameter_mm, 7);
  EXPECT_EQ(parsed.rows[1].diameter_mm, 9) << "the first row of a tool counts";
  EXPECT_EQ(parsed.messages(),
            "1:3: warning: a tab separates the words; LinuxCNC 2.9 skips such a row\n"
            "2:9: warning: a blank before the carriage return; LinuxCNC 2.9 skips such a row\n"
            "3:0: warning: tool 4 has a row already; the first one counts\n");
}

TEST(ToolTable, LimitsOfLinuxcnc) {
  EXPECT_EQ(Parsed("T1 P1 ;" + std::string(300, 'x')).rows.size(), 0u);
  std::string many;
  for (int i = 1; i <= 1001; ++i) many.append("T").append(std::to_string(i)).append(" P1\n");
  const Parsed parsed(many);
  EXPECT_EQ(parsed.rows.size(), 1000u);
  EXPECT_EQ(parsed.messages(), "1001:0: error: more than 1000 rows; LinuxCNC holds no more\n");
}

TEST(ToolTable, AnyPrefixOfATableIsRead) {
  const std::string table = "T1 P1 D6 Z10 ;a\r\nT2\tP2 D8\nT3 P3 K9\n;\nT9 P9 D1e1 Q3";
  for (std::size_t bytes = 0; bytes <= table.size(); ++bytes) {
    const Parsed parsed(table.substr(0, bytes));
    EXPECT_LE(parsed.rows.size(), 3u);
  }
}

TEST(ToolTable, UnreadableFiles) {
  TestFolder folder;
  Diagnostics diagnostics;
  const auto missing = read_tool_table(folder.path("none.tbl"), diagnostics);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error(),
            "cannot read " + folder.path("none.tbl") + ": No such file or directory");
  const auto directory = read_tool_table(folder.path("tmp"), diagnostics);
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error(), "cannot read " + folder.path("tmp") + ": it is not a regular file");
  const auto table = read_tool_table(folder.write("t.tbl", "T5 P1 D4\n"), diagnostics);
  ASSERT_TRUE(table);
  EXPECT_EQ(table->at(0).tool, 5);
  EXPECT_TRUE(diagnostics.empty());
}

TEST(InterpreterTable, InchDiametersAndNoLengths) {
  ToolTableRow row;
  row.tool = 7;
  row.pocket = 3;
  row.diameter_mm = 6;
  row.offset_mm = {1, 2, 50};
  row.orientation = 2;
  NamedTools named;
  named.numbers = {4, 7};
  const InterpreterToolTable table = interpreter_tool_table({row}, named);
  EXPECT_EQ(table.text,
            "T7 P3 U0.2755905512 W0.0393700787 D0.2362204724 I0.000000 J0.000000 Q2\n"
            "T4 P4 U0.1574803150 W0.0393700787 D0.0000000000 I0.000000 J0.000000 Q0\n")
      << "U and W name the row, in mm";
  EXPECT_EQ(table.tool_by_index, (std::vector<int>{0, 7, 4}));
}

TEST(InterpreterTable, ComputedToolNumbersGetRows) {
  NamedTools named;
  named.computed = true;
  EXPECT_EQ(interpreter_tool_table({}, named).tool_by_index.size(), 100u);
}

}  // namespace
}  // namespace kerf
