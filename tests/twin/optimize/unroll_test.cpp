#include "twin/optimize/unroll.h"

#include <gtest/gtest.h>

#include <cmath>

#include "twin/optimize/nc_parameters.h"

namespace kerf {
namespace {

std::string unrolled(const std::string& text) {
  const Result<UnrolledText> out = unroll(NcText(text, false));
  return out ? out->text : "error: " + out.error();
}

std::optional<double> value(std::string_view text, const NcParameters& parameters = {}) {
  NcExpression expression(text, parameters);
  std::size_t at = 0;
  const std::optional<double> out = expression.value(at);
  return out && at == text.size() ? out : std::nullopt;
}

TEST(NcExpression, BindsAsTheInterpreterDoes) {
  EXPECT_EQ(value("[2+3*4**2]"), 50);
  EXPECT_EQ(value("[2 - 3 - 4]"), -5);
  EXPECT_EQ(value("[7 mod 4 + -8 MOD 5]"), 5);  // never below 0
  EXPECT_EQ(value("[1 + 1 EQ 2 AND 3 GT 4]"), 0);
  EXPECT_EQ(value("[1 LT 2 xor 1 le 1]"), 0);
  EXPECT_EQ(value("[1.00005 eq 1]"), 1);
  EXPECT_EQ(value("-[3]"), -3);
  EXPECT_EQ(value("fix[-2.5]"), -3);
  EXPECT_EQ(value("FUP[-2.5]"), -2);
  EXPECT_EQ(value("round[-2.5]"), -3);
  EXPECT_NEAR(value("sin[30]").value(), 0.5, 1e-15);
  EXPECT_NEAR(value("atan[1]/[-1]").value(), 135, 1e-12);
  EXPECT_EQ(value("s q r t [ 1 6 ]"), 4);
  EXPECT_EQ(value("[1 1]"), 11);
}

TEST(NcExpression, ReadsParameters) {
  NcParameters parameters;
  parameters.set(5, 31);
  parameters.set(31, 2.5);
  parameters.set("deep", -3);
  parameters.set("_all", 7);
  EXPECT_EQ(value("#5", parameters), 31);
  EXPECT_EQ(value("##5", parameters), 2.5);
  EXPECT_EQ(value("#[30+1]", parameters), 2.5);
  EXPECT_EQ(value("#<Deep>", parameters), -3);
  EXPECT_EQ(value("[-#<deep> + #7]", parameters), 3);  // #7 is 0
  EXPECT_EQ(value("exists[#<deep>]", parameters), 1);
  EXPECT_EQ(value("exists[#<other>]", parameters), 0);
  parameters.begin_call({11, 12});
  EXPECT_EQ(value("[#1 + #2 + #5]", parameters), 23);
  EXPECT_EQ(value("#<_all>", parameters), 7);
  EXPECT_EQ(value("#<deep>", parameters), std::nullopt);
}

TEST(NcExpression, SaysWhatItCannotKnow) {
  for (const char* text : {"#50", "#5420", "#<_x>", "[1+", "[1", "[1/0]", "sqrt[-1]", "foo[1]",
                           "#0", "#[1.5]", "exists[#<_x>]"}) {
    const NcParameters none;
    NcExpression expression(text, none);
    std::size_t at = 0;
    EXPECT_FALSE(expression.value(at).has_value()) << text;
    EXPECT_FALSE(expression.fault().empty()) << text;
  }
  const std::string deep = std::string(100'000, '[') + "1" + std::string(100'000, ']');
  EXPECT_EQ(value(deep), std::nullopt);
}

TEST(NcExpression, NumbersAreReadAsTheyWere) {
  for (const double number :
       {0.0, 1.0, -2.5, 0.1, 1.0 / 3, 1e-9, 123456.789, 6.123233995736766e-17}) {
    const std::string text = exact_text(number);
    EXPECT_EQ(text.find('e'), std::string::npos);
    if (std::abs(number) > 1e-12 || number == 0) {
      EXPECT_EQ(std::stod(text), number) << text;
    }
  }
}

TEST(Unroll, WhatHasNoLoopsStaysByteForByte) {
  const std::string text = "%\r\nN10 G21 (inch? no)\r\n\r\n  g1x 1 0 f200 ; slow\r\nM2\r\n%\r\n";
  EXPECT_EQ(unrolled(text), text);
}

TEST(Unroll, WritesPassesOut) {
  EXPECT_EQ(unrolled("#1=1\no100 while [#1 LE 2] (deeper)\nG1 Z[-#1*0.5] F300 (pass)\n#1=[#1+1]\n"
                     "o100 endwhile\nM2\n"),
            "(line 2: o100 while, pass 1)\nG1 Z-0.5 F300 (pass)\n(line 2: o100 while, pass 2)\n"
            "G1 Z-1 F300 (pass)\nM2\n");
  EXPECT_EQ(unrolled("o1 repeat [2]\nG91 G1 X1\no1 endrepeat\nM2\n"),
            "(line 1: o1 repeat, pass 1)\nG91 G1 X1\n(line 1: o1 repeat, pass 2)\nG91 G1 X1\nM2\n");
  EXPECT_EQ(unrolled("#<n>=0\no1 do\n#<n>=[#<n>+1]\no2 if [#<n> eq 2]\no1 continue\no2 endif\n"
                     "G0 X#<n>\no3 if [#<n> ge 3]\no1 break\no3 endif\no1 while [1]\nM2\n"),
            "(line 2: o1 do, pass 1)\nG0 X1\n(line 2: o1 do, pass 2)\n(line 2: o1 do, pass 3)\n"
            "G0 X3\nM2\n");
}

TEST(Unroll, WritesSubroutinesOut) {
  EXPECT_EQ(
      unrolled("o<hole> sub\nG0 X#1 Y#2\no9 if [#2 gt 5]\no<hole> return [#1]\no9 else\nG1 Z-1\n"
               "o9 endif\no<hole> endsub [7]\no<hole> call [1] [2]\nG0 X#<_value>\n"
               "o<hole> call [3] [6]\nG0 X#<_value>\nM2\n"),
      "(line 9: o<hole> call)\nG0 X1 Y2\nG1 Z-1\nG0 X7\n(line 11: o<hole> call)\nG0 X3 Y6\n"
      "G0 X3\nM2\n");
}

/// The values of a line are those from before it.
TEST(Unroll, SettingsCountBehindTheirLine) {
  EXPECT_EQ(unrolled("#1=5\n#1=[#1+1] G0 X#1\nG0 Y#1\nM2\n"), " G0 X5\nG0 Y6\nM2\n");
}

TEST(Unroll, LinesAreRemembered) {
  const UnrolledText out =
      unroll(NcText("o1 repeat [2]\nG91 G1 X1\no1 endrepeat\nM2\n", false)).value();
  EXPECT_EQ(out.line_before, (std::vector<std::uint32_t>{0, 2, 0, 2, 4}));
  EXPECT_EQ(out.passes, 2U);
}

TEST(Unroll, SaysWhatItCannotFollow) {
  const std::vector<std::pair<const char*, const char*>> cases{
      {"G0 X#5420\nM2\n", "line 1: #5420 is read"},
      {"G38.2 Z-5 F50\nG0 Z[#5063+1]\nM2\n", "line 2: #5063 is read"},
      {"o<probe> call\nM2\n", "line 1: the subroutine o<probe> is not in this file"},
      {"o1 while [1]\nG0 X1\nM2\n", "does not end"},
      {"o1 endwhile\n", "without its beginning"},
      {"o1 while [1]\no1 endwhile\nM2\n", "a loop that does not end"},
      {"/#1=2\nG0 X#1\nM2\n", "may be deleted"},
      {"/o1 if [1]\no1 endif\nM2\n", "may be deleted"},
      {"M98 P100\nM2\n", "M98"},
      {"#1=2 o1 call\nM2\n", "behind something else"},
      {"#5220=1\nM2\n", "which is the machine's"},
      {"o1 sub\no1 call\no1 endsub\no1 call\nM2\n", "too deeply"},
  };
  for (const auto& [text, says] : cases) {
    const std::string out = unrolled(text);
    EXPECT_TRUE(out.starts_with("error: --unroll: ")) << text << out;
    EXPECT_NE(out.find(says), std::string::npos) << text << out;
  }
}

}  // namespace
}  // namespace kerf
