// What a window makes of a report of `kerf run --enter`.
#include "twin/cli/entry_ask.h"

#include <gtest/gtest.h>

#include <string>

namespace kerf {
namespace {

constexpr const char* kReport = R"({"schema": "kerf-report/1", "entry": {"line": 28,
  "text": ["at line 28; the tool is then at X25.40 Y0.00 Z5.00 mm", "a start there misses nothing"],
  "safe": {"clear": true, "points_mm": [[1, 2, 3], [1, 2, 8]], "findings": []},
  "drive": {"clear": false, "points_mm": [[1, 2, 3], [4, 5, 6]], "findings": [], "feed": true},
  "earlier": [{"line": 11, "costs_s": 31.7, "changes_tool": false},
              {"line": 4, "costs_s": 96, "changes_tool": true}]}})";

TEST(EntryAnswer, HasWhatTheReportHas) {
  const auto answer = entry_answer(28, kReport, LengthUnit::kMm);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->line, 28);
  EXPECT_FALSE(answer->is_busy);
  EXPECT_EQ(answer->trouble, "");
  ASSERT_EQ(answer->text.size(), 2U);
  EXPECT_EQ(answer->text[1], "a start there misses nothing");
  EXPECT_TRUE(answer->safe.is_clear);
  ASSERT_EQ(answer->safe.points_mm.size(), 2U);
  EXPECT_EQ(answer->safe.points_mm[1], Vec3(1, 2, 8));
  EXPECT_FALSE(answer->drive.is_clear);
  ASSERT_EQ(answer->earlier.size(), 2U);
  EXPECT_EQ(answer->earlier[0].line, 11);
  EXPECT_DOUBLE_EQ(answer->earlier[0].costs_s, 31.7);
  EXPECT_FALSE(answer->earlier[0].changes_tool);
  EXPECT_TRUE(answer->earlier[1].changes_tool);
}

TEST(EntryAnswer, IsInTheUnitOfTheWindow) {
  const auto answer = entry_answer(28, kReport, LengthUnit::kInch);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->text[0].find("mm"), std::string::npos) << answer->text[0];
  EXPECT_NE(answer->text[0].find("in"), std::string::npos) << answer->text[0];
}

TEST(EntryAnswer, OfNoReportOrHalfAOneIsNone) {
  const std::string whole = kReport;
  EXPECT_FALSE(entry_answer(28, R"({"schema": "kerf-report/1"})", LengthUnit::kMm));
  EXPECT_FALSE(entry_answer(28, R"({"entry": 3})", LengthUnit::kMm));
  EXPECT_FALSE(entry_answer(28, R"({"entry": {"text": [1], "safe": {}}})", LengthUnit::kMm));
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    EXPECT_FALSE(entry_answer(28, whole.substr(0, length), LengthUnit::kMm)) << length;
  }
}

}  // namespace
}  // namespace kerf
