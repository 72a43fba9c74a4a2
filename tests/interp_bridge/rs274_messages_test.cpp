#include "interp_bridge/rs274_messages.h"

#include <gtest/gtest.h>

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

TEST(InterpreterDiagnostic, MissingEndIsAWarning) {
  const Diagnostic said = interpreter_diagnostic(
      "executing\nFile ended with no percent sign or program end\nN4G0 X1\n", {"a.ngc"}, {0, 4}, 4);
  EXPECT_EQ(
      to_string(said),
      "a.ngc:4: warning: the program has no end: File ended with no percent sign or program end\n"
      "   hint: end it with M2 or M30, or put it between two lines of %\n");
}

TEST(InterpreterDiagnostic, UnnumberedEchoIsLookedUp) {
  TestFolder folder;
  const std::string text = "G0 X1 (" + std::string(240, 'a') + ") Q";
  const std::string main = folder.write("main.ngc", "G21\nG0\n" + text + "\nM2\n");
  EXPECT_EQ(interpreter_diagnostic("oops\n" + text + "\n", {main}, {0, 2}, 4).line, 3);
}

}  // namespace
}  // namespace kerf
