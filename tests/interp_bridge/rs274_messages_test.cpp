#include "interp_bridge/rs274_messages.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

TEST(InterpreterMessage, MessageAndEchoedLine) {
  const InterpreterMessage said = parse_interpreter_message(
      "executing\nlink (updating variable file): No such file or directory\n"
      "Unknown g code used\nN2G99.9\n");
  EXPECT_EQ(said.message, "Unknown g code used");
  EXPECT_EQ(said.echo, "N2G99.9");
}

TEST(InterpreterMessage, EmptyEchoAndSilence) {
  const InterpreterMessage said =
      parse_interpreter_message("executing\nFile ended with no percent sign\n\n");
  EXPECT_EQ(said.message, "File ended with no percent sign");
  EXPECT_EQ(said.echo, "");
  EXPECT_EQ(parse_interpreter_message("executing\n").message, "");
}

TEST(InterpreterDiagnostic, LineAndExcerptAreTheUsers) {
  TestFolder folder;
  const std::string main = folder.write("main.ngc", "G21\no<s> call\nM2\n");
  const std::string sub = folder.write("s.ngc", "o<s> sub\n  N70 G0 X1 X2\no<s> endsub\n");
  const Diagnostic said = interpreter_diagnostic(
      "executing\nMultiple x words on one line\nN100000002G0 X1 X2\n", {main, sub}, {0, 2}, 3);
  EXPECT_EQ(to_string(said),
            sub + ":2: error: Multiple x words on one line\n     2 |   N70 G0 X1 X2\n");
}

TEST(InterpreterDiagnostic, QuotedLinesLoseOurNumber) {
  const Diagnostic said = interpreter_diagnostic(
      "38: duplicate O-word label - already defined in line 20: 'N38o999 if [1]'\nN38o999 if [1]\n",
      {"none.ngc"}, {0, 37}, 90);
  EXPECT_EQ(said.message, "38: duplicate O-word label - already defined in line 20: 'o999 if [1]'");
  EXPECT_EQ(said.line, 38);
}

TEST(InterpreterDiagnostic, MessageThatNamesItsLine) {
  const Diagnostic said =
      interpreter_diagnostic("EOF in file:main.ngc seeking o-word: o<nosuch> from line: 2\nN9M2\n",
                             {"dir/main.ngc"}, {0, 1}, 9);
  EXPECT_EQ(said.line, 2);
  EXPECT_EQ(said.hint,
            "a subroutine that the program calls must be in it, or in NAME.ngc beside it");
}

TEST(InterpreterDiagnostic, CodesOfOtherControls) {
  for (const char* said :
       {"Unknown m code used: M31\nN8M31\n", "M-code greater than 199: M429\nN8M429\n"}) {
    EXPECT_EQ(interpreter_diagnostic(said, {"a.ngc"}, {0, 7}, 9).hint,
              "LinuxCNC has no such code and stops here, too, but where an INI remaps it (--ini)");
  }
}

/// The hint at a block that LinuxCNC refuses with these words.
std::string hint_of(const std::string& block, const std::string& message) {
  const TestFolder folder;
  const std::string main = folder.write("main.ngc", block + "\n");
  return interpreter_diagnostic(message + "\nN1" + block + "\n", {main}, {0, 1}, 1).hint;
}

TEST(InterpreterDiagnostic, ReferenceMovesOfOtherControls) {
  const std::string two = "Cannot use two g codes that both use axis values";
  const std::string wanted = "G28 and G30 traverse by themselves: no G0 or G1 in their block";
  for (const char* block : {"G0 G91 G28 Z0", "N100G28G91G0Z0", "g0 g 30 Z0", "(home) G00 G28 Z0"})
    EXPECT_EQ(hint_of(block, two), wanted) << block;
  for (const char* block :
       {"G0 G92 X0", "G0 G28.1 X0 G92", "G1 G10 L2 (G28)", "G0 G280", "G28 G92 X0"})
    EXPECT_EQ(hint_of(block, two), "") << block;
}

TEST(InterpreterDiagnostic, CentresThatArePlaces) {
  // Start (-40,50), end (-30,40): from the place (-40,40) both are 10.
  const std::string fits =
      "Radius to end of arc differs from radius to start: start=(X-40.0000,Y50.0000) "
      "center=(X-80.0000,Y90.0000) end=(X-30.0000,Y40.0000) r1=56.5685 r2=70.7107 abs_err=14.14 "
      "rel_err=20.0000%";
  EXPECT_EQ(hint_of("G3 X-30. Y40. I-40 J40.", fits),
            "as a place, and not from the arc's start, the centre fits: G90.1 says so");
  // The same with an end (-30,41): neither.
  std::string off = fits;
  off.replace(off.find("Y40.0000"), 8, "Y41.0000");
  EXPECT_EQ(hint_of("G3 X-30. Y41. I-40 J40.", off), "");
  EXPECT_EQ(hint_of("G3 X-30.", "Radius to end of arc differs from radius to start"), "");
}

TEST(InterpreterDiagnostic, DwellsAndPlanesOfOtherControls) {
  const std::string dwell = "P word with no G2 G3 G4 G10 G64 G5 G5.2 G76 G82 to use it";
  EXPECT_EQ(hint_of("G83 X1 Z-5 R2 P500 Q2", dwell),
            "LinuxCNC dwells at the bottom of G82, G86, G88 and G89 only: no P here");
  EXPECT_EQ(hint_of("G1 X1 P500", dwell), "");
  EXPECT_EQ(hint_of("G3 X1 Z-1 I0 K-1", "K word given for arc in xy plane"),
            "an arc of X and Z lies in G18");
}

TEST(InterpreterDiagnostic, WordsOfOtherControls) {
  const std::string macro =
      "the macro language of another control; here it is o100 while [..] and o100 endwhile, o101 "
      "if [..] and o101 endif, and there is no GOTO";
  for (const char* block : {"WHILE [#1 GT #2] DO1", "N20 END1", "goto 10"})
    EXPECT_EQ(hint_of(block, "Unknown word where unary operation could be"), macro) << block;
  EXPECT_EQ(hint_of("IF [#1 EQ 0] GOTO 10", "Unknown word starting with f"), macro);
  EXPECT_EQ(hint_of("o100 while [#1 GT #2", "Unknown word where unary operation could be"), "");
  EXPECT_EQ(hint_of("X[whil[1]]", "Unknown word starting with h"), "");

  const std::string unknown = "Unknown g code used";
  EXPECT_EQ(hint_of("G31 Z-10 F50", unknown), "here a probing move is G38.2");
  EXPECT_EQ(hint_of("N5 G54.1 P3", unknown), "here work offsets are G54 to G59 and G59.1 to G59.3");
  EXPECT_EQ(hint_of("G65 P9810", unknown),
            "here a macro is a subroutine: o<name> call [..], with its arguments in brackets");
  EXPECT_EQ(hint_of("G68 X0 Y0 R45", unknown), "here a work offset turns: G10 L2 P1 R30");
  EXPECT_EQ(hint_of("G05.1 Q1", "All axes missing with motion code"),
            "here G5.1 is a spline; what looks ahead elsewhere is G64 P: leave it out");
  EXPECT_EQ(hint_of("G05", "All axes missing with motion code"), "");
  EXPECT_EQ(hint_of("(G31) G36 Z1", unknown),
            "LinuxCNC has no such code and stops here, too, but where an INI remaps it (--ini)");

  EXPECT_EQ(hint_of(":O1001", "Bad character ':' used"),
            "here a program has no number: leave the line out");
  EXPECT_EQ(hint_of("G1 X5 ,R2", "Bad character ',' used"),
            "here no word rounds or breaks a corner: its arc or its chamfer is a block");
  EXPECT_EQ(hint_of("G1 X5,5", "Bad character ',' used"), "");
  EXPECT_EQ(hint_of("$H (home)", "Unknown word where unary operation could be"),
            "a command of GRBL, not of a program: leave it out");
}

TEST(InterpreterDiagnostic, CommentsAndFeedsThatAreNone) {
  EXPECT_EQ(hint_of("(a (b) c)", "Nested comment found"),
            "a comment ends at its first ): no ( lies within it");
  EXPECT_EQ(hint_of("( a", "Unclosed comment found"), "a comment ends in its own line");
  EXPECT_EQ(hint_of("G1 F0.000 X1", "Cannot do g1 with zero feed rate"),
            "the block itself says F0");
  EXPECT_EQ(hint_of("G1 X1 (F0)", "Cannot do g1 with zero feed rate"), "");
}

TEST(InterpreterDiagnostic, CentresWithAnIdleWord) {
  const std::string refused = "K word given for arc in xy plane";
  for (const char* const idle :
       {"G2 X10 Y0 I5 J0 K0.000 F100", "g3x10y0i5j0k0", "G2 X10 Y0 Z-1 I5 J0 K -0.0",
        "(Z down) G2 Y10 I5 K+0", "G2 X10 I5 K0 (Z0)"}) {
    EXPECT_EQ(hint_of(idle, refused),
              "an arc of X and Y has no K, not even one of 0: leave the word out")
        << idle;
  }
  for (const char* const in_xz : {"G2 X10 Z-5 I5 K0", "G2 X10 Y0 Z-5 I5 K-1",
                                  "G2 X10 Y0 I5 J0 K0.5", "G2 X1 Y0 K#1", "G2 X1 Z0 I1 K0 (J0)"}) {
    EXPECT_EQ(hint_of(in_xz, refused), "an arc of X and Z lies in G18") << in_xz;
  }
}

TEST(InterpreterDiagnostic, MissingEndIsAWarning) {
  const Diagnostic said = interpreter_diagnostic(
      "executing\nFile ended with no percent sign or program end\nN4G0 X1\n", {"a.ngc"}, {0, 4}, 4);
  EXPECT_EQ(
      to_string(said),
      "a.ngc:4: warning: the program has no end: File ended with no percent sign or program end\n"
      "   hint: end it with M2 or M30, or put it between two lines of %\n");
}

TEST(InterpreterDiagnostic, FilesOfSubroutinesNeedNoEnd) {
  const TestFolder folder;
  const auto said = [&](const std::string& text) {
    const std::string main = folder.write("main.ngc", text);
    const std::string message = "File ended with no percent sign or program end\nN1\n";
    return interpreter_diagnostic(message, {main}, {0, 1}, 1);
  };
  const std::string only = "the file only defines subroutines (";
  const std::string rest = ") and calls none: nothing is run";
  for (const auto& [text, names] : std::vector<std::pair<std::string, std::string>>{
           {"(a hole)\n\nO<Hole> sub (x)\nG1 X1\no<hole> endsub [1] ; x\n", "o<hole>"},
           {"n10 o100sub\r\no101 if [1]\nM2\no101 endif\nN20 O100 endsub\r\n", "o100"},
           {"o1 sub\no1 endsub\no2 sub\no2 endsub\no3 sub\no3 endsub\no4 sub\no4 endsub",
            "o1, o2, o3, .."}}) {
    EXPECT_EQ(said(text).message, only + names + rest) << text;
    EXPECT_EQ(said(text).severity, Severity::kNote) << text;
  }
  for (const char* const text : {"o<a> sub\no<a> endsub\nG0 X1\n", "G21\no<a> sub\no<a> endsub\n",
                                 "o<a> sub\no<a> endsub\no<a> call\n", "o<a> sub\nG0 X1\n",
                                 "o<a> endsub\n", "(none)\n", "G0 X1 (o<a> sub)\n", ""}) {
    EXPECT_EQ(said(text).severity, Severity::kWarning) << text;
  }
}

TEST(InterpreterDiagnostic, UnnumberedEchoIsLookedUp) {
  TestFolder folder;
  const std::string text = "G0 X1 (" + std::string(240, 'a') + ") Q";
  const std::string main = folder.write("main.ngc", "G21\nG0\n" + text + "\nM2\n");
  EXPECT_EQ(interpreter_diagnostic("oops\n" + text + "\n", {main}, {0, 2}, 4).line, 3);
}

}  // namespace
}  // namespace kerf
