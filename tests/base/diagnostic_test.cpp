#include "base/diagnostic.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

TEST(Diagnostic, shows_place_excerpt_caret_and_hint) {
  const Diagnostic d{Severity::kError,
                     "part.yaml",
                     14,
                     12,
                     "stock.cell_mm: 0 is not allowed; must be above 0 (mm)",
                     "  cell_mm: 0",
                     "0.05 to 0.2 suits most parts"};
  EXPECT_EQ(to_string(d),
            "part.yaml:14:12: error: stock.cell_mm: 0 is not allowed; must be above 0 (mm)\n"
            "    14 |   cell_mm: 0\n"
            "       |            ^\n"
            "   hint: 0.05 to 0.2 suits most parts\n");
}

TEST(Diagnostic, leaves_out_what_is_not_known) {
  Diagnostic d;
  d.message = "no program given";
  EXPECT_EQ(to_string(d), "kerf: error: no program given\n");
  d.file = "part.ngc";
  EXPECT_EQ(to_string(d), "part.ngc: error: no program given\n");
  d.column = 3;  // means nothing without a line
  EXPECT_EQ(to_string(d), "part.ngc: error: no program given\n");
  d.line = 118;
  d.column = 0;
  EXPECT_EQ(to_string(d), "part.ngc:118: error: no program given\n");
}

TEST(Diagnostic, without_a_column_has_no_caret) {
  Diagnostic d;
  d.severity = Severity::kWarning;
  d.file = "part.ngc";
  d.line = 7;
  d.message = "no M2";
  d.excerpt = "G0 X1";
  EXPECT_EQ(to_string(d), "part.ngc:7: warning: no M2\n     7 | G0 X1\n");
}

TEST(Diagnostic, caret_stands_under_the_first_column) {
  Diagnostic d;
  d.severity = Severity::kNote;
  d.file = "a.ngc";
  d.line = 1;
  d.column = 1;
  d.message = "here";
  d.excerpt = "X1";
  EXPECT_EQ(to_string(d), "a.ngc:1:1: note: here\n     1 | X1\n       | ^\n");
}

TEST(Diagnostic, control_characters_cannot_reach_the_terminal) {
  Diagnostic d;
  d.file = "a\x1b[2J";
  d.line = 1;
  d.message = "bad\nbyte \x7f";
  d.excerpt = "\tG1\r";
  EXPECT_EQ(to_string(d), "a?[2J:1: error: bad?byte ?\n     1 | ?G1?\n");
}

TEST(Diagnostic, bytes_beyond_ascii_are_kept) {
  Diagnostic d;
  d.message =
      "Werkst\xc3\xbc"
      "ck";
  EXPECT_EQ(to_string(d),
            "kerf: error: Werkst\xc3\xbc"
            "ck\n");
}

TEST(Diagnostic, has_error_looks_at_severity) {
  Diagnostics list(2);
  list[0].severity = Severity::kNote;
  list[1].severity = Severity::kWarning;
  EXPECT_FALSE(has_error({}));
  EXPECT_FALSE(has_error(list));
  list.push_back({});
  EXPECT_TRUE(has_error(list));
}

TEST(Diagnostic, severities_have_names) {
  EXPECT_STREQ(to_string(Severity::kNote), "note");
  EXPECT_STREQ(to_string(Severity::kWarning), "warning");
  EXPECT_STREQ(to_string(Severity::kError), "error");
}

}  // namespace
}  // namespace kerf
