#include "interp_bridge/ini_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "interp_bridge/ini_include.h"
#include "interp_bridge/machine_limits.h"
#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

/// An INI "dir/m.ini" among files that exist in the test alone.
struct Parsed {
  Diagnostics diagnostics;
  std::vector<std::string> asked_for;
  IniFile ini;

  explicit Parsed(std::string_view text, const std::map<std::string, std::string>& files = {})
      : ini(IniFile::parse(
            text, "dir/m.ini",
            [&](const std::string& path) -> Result<std::string> {
              asked_for.push_back(path);
              const auto found = files.find(path);
              if (found == files.end()) return Error{"cannot read " + path + ": no such thing"};
              return found->second;
            },
            diagnostics)) {}

  std::string messages() const {
    std::string text;
    for (const Diagnostic& one : diagnostics) {
      text += one.file.substr(one.file.find('/') + 1) + ":" + std::to_string(one.line) + ":" +
              std::to_string(one.column) + ": " + kerf::to_string(one.severity) + ": " +
              one.message + "\n";
    }
    return text;
  }
  /// The values of a key, each with a '|' behind it.
  std::string all(std::string_view section, std::string_view key) {
    std::string text;
    for (const IniEntry* entry : ini.find_all(section, key)) text += entry->value + "|";
    return text;
  }
};

TEST(IniFile, SectionsKeysAndTheirPlaces) {
  Parsed parsed("# a comment\n[A]\n  KEY =  some words \t\n;another\n\n\t[B]\nKEY=2\nEMPTY =\n");
  EXPECT_EQ(parsed.messages(), "");
  const IniEntry* const entry = parsed.ini.find("A", "KEY");
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->value, "some words");
  EXPECT_EQ(entry->line, 3);
  EXPECT_EQ(entry->key_column, 3);
  EXPECT_EQ(entry->value_column, 10);
  EXPECT_EQ(entry->excerpt, "  KEY =  some words \t");
  EXPECT_EQ(entry->file, 0U);
  EXPECT_EQ(parsed.all("B", "KEY"), "2|");
  EXPECT_EQ(parsed.ini.find("B", "EMPTY"), nullptr);
  EXPECT_EQ(parsed.ini.entries().back().value_column, 7) << "behind the =";
  EXPECT_EQ(parsed.ini.find("A", "key"), nullptr) << "case counts";
  EXPECT_EQ(parsed.ini.find("a", "KEY"), nullptr);
  EXPECT_TRUE(parsed.ini.has_section("B"));
  EXPECT_FALSE(parsed.ini.has_section("b"));
  EXPECT_EQ(parsed.ini.files(), std::vector<std::string>{"dir/m.ini"});
  EXPECT_EQ(parsed.ini.expanded_text(), "");
}

TEST(IniFile, WhatWasNotAskedForIsKnown) {
  Parsed parsed("[A]\nX = 1\nX = 2\nY = 1\nZ 5\n");
  parsed.ini.find("A", "X");
  std::string out;
  for (const IniEntry& entry : parsed.ini.entries()) out += entry.key + (entry.asked ? "+" : "-");
  EXPECT_EQ(out, "X+X+Y-Z+") << "of Z a warning tells already";
}

TEST(IniFile, RepeatedKeysEndAtOneWithoutAValue) {
  EXPECT_EQ(Parsed("[A]\nF=1\nG=9\nF = 2\n[B]\nF=7\n").all("A", "F"), "1|2|");
  EXPECT_EQ(Parsed("[A]\nF=1\nF=\nF=3\n").all("A", "F"), "1|");
  Parsed parsed("[A]\nF=1\nF 2\nF=3\n");
  EXPECT_EQ(parsed.all("A", "F"), "1|");
  EXPECT_EQ(parsed.messages(),
            "m.ini:3:1: warning: neither [SECTION] nor KEY = value; LinuxCNC looks for no F behind "
            "it\n");
}

TEST(IniFile, WhatLinuxcncPassesOverIsAWarning) {
  Parsed parsed("K = 0\nword\n[A]\nword\nK = 1\n[A]\nK = 2\n [B\nK = 3\n");
  EXPECT_EQ(parsed.messages(),
            "m.ini:1:1: warning: a value before the first [SECTION]; LinuxCNC does not find it\n"
            "m.ini:2:1: warning: neither [SECTION] nor KEY = value; LinuxCNC passes over it\n"
            "m.ini:4:1: warning: neither [SECTION] nor KEY = value; LinuxCNC passes over it\n"
            "m.ini:6:1: warning: [A] stands a second time; LinuxCNC reads the first only\n"
            "m.ini:8:2: warning: the ] of the section is missing; LinuxCNC finds no section of "
            "this name\n");
  EXPECT_EQ(parsed.all("A", "K"), "1|");
  EXPECT_FALSE(parsed.ini.has_section("B"));
}

TEST(IniFile, BackslashesJoinLines) {
  Parsed parsed("[A]\nK = 1\\\n 2\\\n3\nL = 4\n\\\n \\\n  M = 5\n# C:\\dir\\\nN = 6\nO = 7\\");
  EXPECT_EQ(parsed.messages(), "");
  EXPECT_EQ(parsed.all("A", "K"), "1 23|");
  const IniEntry* const after = parsed.ini.find("A", "L");
  ASSERT_NE(after, nullptr);
  EXPECT_EQ(after->line, 5);
  const IniEntry* const below_blanks = parsed.ini.find("A", "M");
  ASSERT_NE(below_blanks, nullptr);
  EXPECT_EQ(below_blanks->line, 8);
  EXPECT_EQ(below_blanks->key_column, 3);
  EXPECT_EQ(below_blanks->excerpt, "  M = 5");
  EXPECT_EQ(parsed.ini.find("A", "N"), nullptr) << "part of the comment";
  EXPECT_EQ(parsed.all("A", "O"), "7\\|") << "no newline, no joining";

  Parsed joined("[A]\nK\\\n= 1\n");
  const IniEntry* const entry = joined.ini.find("A", "K");
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->key_column, 1);
  EXPECT_EQ(entry->value_column, 0) << "in the line joined to it";
}

TEST(IniFile, BackslashesThatJoinTooMuch) {
  Parsed last("[A]\nJ=1\nK=1\\\n");
  EXPECT_EQ(last.messages(),
            "m.ini:3:0: warning: a backslash joins the last line to nothing; LinuxCNC passes over "
            "it\n");
  EXPECT_EQ(last.ini.find("A", "K"), nullptr);
  EXPECT_EQ(Parsed("[A]\n# K=1\\\n").messages(), "");

  std::string lines = "[A]\nK=";
  for (int i = 0; i < 20; ++i) lines += "1\\\n";
  EXPECT_EQ(Parsed(lines + "2\n").all("A", "K"), "111111111111111111112|");
  Parsed many(lines + "1\\\n2\n");
  EXPECT_EQ(many.messages().substr(0, many.messages().find('\n')),
            "m.ini:22:0: error: more than 20 lines joined by backslashes; LinuxCNC stops here");

  Parsed section("[A]\n# C:\\dir\\\n[B]\nK=2\n");
  EXPECT_EQ(section.messages(),
            "m.ini:3:0: warning: a backslash joins this section to the line before; LinuxCNC finds "
            "it all the same\n");
  EXPECT_EQ(section.all("B", "K"), "2|");

  Parsed unended("[A]\nK=1\\\n23");
  EXPECT_EQ(unended.messages(),
            "m.ini:3:0: warning: no newline behind a line that a backslash joins to another; "
            "LinuxCNC loses its last byte\n");
  EXPECT_EQ(unended.all("A", "K"), "12|");
}

TEST(IniFile, DosLineEnds) {
  Parsed parsed("[A]\r\nK = 1\r\n\r\nL = 2\\\r\nM = 3\r");
  EXPECT_EQ(parsed.messages(), "m.ini:1:0: warning: the file has DOS line ends\n");
  EXPECT_EQ(parsed.all("A", "K"), "1|");
  EXPECT_EQ(parsed.ini.entries()[0].excerpt, "K = 1");
  EXPECT_EQ(parsed.all("A", "L"), "2\\|") << "no backslash before the newline";
  EXPECT_EQ(parsed.all("A", "M"), "3|");
  EXPECT_EQ(Parsed("[A]\nK = 1\rL = 2\n").messages(),
            "m.ini:2:0: error: a carriage return within a line; LinuxCNC stops here\n");
}

TEST(IniFile, BytesThatAreNoText) {
  Parsed nul(std::string_view("[A]\nK=1\0 2\nL=3\n", 15));
  EXPECT_EQ(nul.messages(), "m.ini:2:4: error: a byte of value 0; this is not text\n");
  EXPECT_EQ(nul.all("A", "L"), "3|");
  Parsed mark("\xef\xbb\xbf[A]\nK=1\n[B]\nL=2\n");
  EXPECT_EQ(mark.messages(),
            "m.ini:1:1: warning: the file begins with a byte order mark; LinuxCNC does not "
            "understand its first line\n"
            "m.ini:2:1: warning: a value before the first [SECTION]; LinuxCNC does not find it\n");
  EXPECT_FALSE(mark.ini.has_section("A"));
  EXPECT_EQ(mark.all("B", "L"), "2|");
}

TEST(IniFile, LongLinesAreSeveral) {
  const std::string x(250, 'x');
  Parsed fits("[A]\nK = " + x + "y\n");
  EXPECT_EQ(fits.messages(), "");
  EXPECT_EQ(fits.all("A", "K"), x + "y|");
  Parsed longer("[A]\nK = " + x + "yL = 2\nM = 3\n");
  EXPECT_EQ(longer.messages(),
            "m.ini:2:255: warning: a line of 260 bytes; LinuxCNC takes what follows the first 255 "
            "for another\n");
  EXPECT_EQ(longer.all("A", "K"), x + "y|");
  const IniEntry* const behind = longer.ini.find("A", "L");
  ASSERT_NE(behind, nullptr);
  EXPECT_EQ(behind->line, 2);
  EXPECT_EQ(behind->key_column, 0);
  EXPECT_EQ(longer.ini.find("A", "M")->line, 3);
  EXPECT_EQ(Parsed("[A]\nK=" + std::string(700, ' ') + "5\nL=6\n").all("A", "L"), "6|");
}

TEST(IniFile, AFileThatIsNoIniSaysSoOnce) {
  std::string lines;
  for (int i = 0; i < 80; ++i) lines += "G1 X" + std::to_string(i) + "\n";
  Parsed program(lines);
  ASSERT_EQ(program.diagnostics.size(), 51U);
  EXPECT_EQ(program.diagnostics.back().message,
            "30 more remarks about its lines; this is not an INI");
  EXPECT_EQ(program.diagnostics.back().severity, Severity::kError);
  Parsed ini("[A]\n" + lines);
  EXPECT_EQ(ini.diagnostics.back().message, "30 more remarks about its lines");
  EXPECT_FALSE(has_error(ini.diagnostics)) << "LinuxCNC reads it";
  EXPECT_TRUE(has_error(Parsed("[A]\n" + lines + "K=1\rL=2\n").diagnostics));
}

TEST(IniFile, IncludesStandInTheirPlace) {
  Parsed parsed("[A]\nK = 1\n#INCLUDE sub/../b.inc  # why\n  L = 3\n#INCLUDE '/abs/c d.inc'\n",
                {{"dir/b.inc", "K = 2\n[B]\n K = 4\n"}, {"/abs/c d.inc", "M=5\n"}});
  EXPECT_EQ(parsed.messages(), "");
  EXPECT_EQ(parsed.all("A", "K"), "1|2|");
  EXPECT_EQ(parsed.all("B", "L"), "3|");
  EXPECT_EQ(parsed.all("B", "M"), "5|");
  EXPECT_EQ(parsed.ini.files(),
            (std::vector<std::string>{"dir/m.ini", "dir/b.inc", "/abs/c d.inc"}));
  const IniEntry* const included = parsed.ini.find("B", "K");
  ASSERT_NE(included, nullptr);
  EXPECT_EQ(included->file, 1U);
  EXPECT_EQ(included->line, 3);
  EXPECT_EQ(included->key_column, 2);
  const IniEntry* const behind = parsed.ini.find("B", "L");
  ASSERT_NE(behind, nullptr);
  EXPECT_EQ(behind->file, 0U);
  EXPECT_EQ(behind->line, 4);
  EXPECT_EQ(behind->key_column, 3) << "as in the file, although the script drops the blanks";
  EXPECT_EQ(behind->value_column, 7);
  EXPECT_EQ(behind->excerpt, "  L = 3");
  // The interpreter is given what was read.
  Parsed again(parsed.ini.expanded_text());
  EXPECT_EQ(again.all("A", "K") + again.all("B", "L"), "1|2|3|");
}

TEST(IniFile, TheScriptThatIncludesChangesOtherLines) {
  Parsed parsed("#INCLUDE b.inc\n[A]\nK = C:\\dir \\\n  on\nL = 1\\\\\nM = 2\nN = 3",
                {{"dir/b.inc", ""}});
  EXPECT_EQ(parsed.all("A", "K"), "C:dir   on|");
  EXPECT_EQ(parsed.all("A", "L"), "1M = 2|");
  EXPECT_EQ(parsed.ini.find("A", "N"), nullptr);
  EXPECT_EQ(parsed.messages(),
            "m.ini:7:0: warning: the last line has no newline; LinuxCNC passes over it in an INI "
            "with #INCLUDE\n");
  Parsed dos("[A]\r\n#INCLUDE b.inc\n[B]\r\nK = 1\r\n", {{"dir/b.inc", "[C]\r\nL = 2\r\n"}});
  EXPECT_EQ(dos.messages(),
            "m.ini:1:0: error: the file has DOS line ends; LinuxCNC stops here in an INI with "
            "#INCLUDE\nb.inc:1:0: warning: the file has DOS line ends\n");
  EXPECT_EQ(dos.all("B", "K") + dos.all("C", "L"), "1|2|");
}

TEST(IniFile, IncludesThatAreNot) {
  setenv("KERF_TEST_FOLDER", "gone", 1);
  Parsed parsed(
      "[A]\n#INCLUDE\n#INCLUDE no.inc\n #INCLUDE ${KERF_TEST_FOLDER}/x\n#INCLUDE $(ls)\n"
      "#INCLUDE *.inc\n#INCLUDE \"open\n#INCLUDE $KERF_TEST_NIX\n#INCLUDES b.inc\nK=1\n");
  unsetenv("KERF_TEST_FOLDER");
  EXPECT_EQ(parsed.asked_for, (std::vector<std::string>{"dir/no.inc", "dir/gone/x"}));
  EXPECT_EQ(parsed.messages(),
            "m.ini:2:1: warning: #INCLUDE names no file\n"
            "m.ini:3:10: warning: #INCLUDE: cannot read dir/no.inc: no such thing; LinuxCNC goes "
            "on without it\n"
            "m.ini:4:11: warning: #INCLUDE: cannot read dir/gone/x: no such thing; LinuxCNC goes "
            "on without it\n"
            "m.ini:5:10: error: #INCLUDE: the shell gives '$' a meaning that is not followed here\n"
            "m.ini:6:10: error: #INCLUDE: the shell gives '*' a meaning that is not followed here\n"
            "m.ini:7:10: error: #INCLUDE: the quote \" is not closed\n"
            "m.ini:8:10: warning: #INCLUDE names no file\n");
  EXPECT_EQ(parsed.all("A", "K"), "1|");

  Parsed indented("[A]\n #INCLUDE b.inc\n", {{"dir/b.inc", "K=1\n"}});
  EXPECT_EQ(indented.messages(),
            "m.ini:2:2: warning: no #INCLUDE stands at the start of a line; LinuxCNC takes this "
            "one for a comment\n");
  EXPECT_TRUE(indented.asked_for.empty());
}

TEST(IniFile, IncludesGoOneLevelDeep) {
  const std::string self = "#INCLUDE m.ini\n[A]\nK=1\n";
  Parsed loop(self, {{"dir/m.ini", self}});
  EXPECT_EQ(loop.messages(),
            "m.ini:1:1: warning: #INCLUDE within an included file; LinuxCNC goes one level deep "
            "and takes it for a comment\n"
            "m.ini:2:1: warning: [A] stands a second time; LinuxCNC reads the first only\n");
  EXPECT_EQ(loop.all("A", "K"), "1|");
  EXPECT_EQ(loop.asked_for.size(), 1U);

  Parsed unended("[A]\n#INCLUDE b.inc\nL=2\n", {{"dir/b.inc", "K=1"}});
  EXPECT_EQ(unended.messages(),
            "b.inc:1:0: warning: an included file without a newline at its end; LinuxCNC adds a "
            "remark of its own to this line\n");
  EXPECT_EQ(unended.all("A", "K"), "1#*** End   #INCLUDE file: b.inc|");
  EXPECT_EQ(unended.all("A", "L"), "2|");

  std::string often;
  for (int i = 0; i < 5; ++i) often += "#INCLUDE big\n";
  const Parsed big(often, {{"dir/big", std::string(300'000, '\n')}});
  EXPECT_EQ(big.messages(),
            "m.ini:4:10: error: #INCLUDE: with dir/big, the included files are larger than 1 MB\n"
            "m.ini:5:10: error: #INCLUDE: with dir/big, the included files are larger than 1 MB\n");
}

TEST(IniFile, ManySectionsTakeNoTime) {
  std::string text;
  for (int i = 0; text.size() < 1'000'000; ++i)
    text.append("[").append(std::to_string(i)).append("]\n");
  const Parsed parsed(text);
  EXPECT_TRUE(parsed.ini.has_section("100000"));
  EXPECT_EQ(parsed.messages(), "");
}

TEST(IniFile, FilesAreReadFromTheFolderOfTheIni) {
  const TestFolder folder;
  folder.write("axes.inc", "[A]\nK=1\n");
  const std::string path = folder.write("m.ini", "#INCLUDE axes.inc\n#INCLUDE .\n");
  Diagnostics diagnostics;
  Result<IniFile> ini = IniFile::read(path, diagnostics);
  ASSERT_TRUE(ini) << ini.error();
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_NE(diagnostics[0].message.find("it is not a regular file"), std::string::npos);
  ASSERT_NE(ini->find("A", "K"), nullptr);
  EXPECT_EQ(ini->files()[1], folder.path("axes.inc"));
  const std::string big = folder.write("big.ini", std::string(1024 * 1024 + 1, '\n'));
  EXPECT_EQ(IniFile::read(big, diagnostics).error(), "cannot read " + big + ": larger than 1 MB");
  EXPECT_EQ(IniFile::read(folder.path("no.ini"), diagnostics).error(),
            "cannot read " + folder.path("no.ini") + ": No such file or directory");
}

TEST(IniFile, PathsOfAnIni) {
  const char* const home = std::getenv("HOME");
  const std::string before = home == nullptr ? "" : home;
  setenv("HOME", "/home/me", 1);
  EXPECT_EQ(resolve_ini_path("tool.tbl", "/cnc/mill"), "/cnc/mill/tool.tbl");
  EXPECT_EQ(resolve_ini_path("../lib/./tool.tbl", "/cnc/mill"), "/cnc/lib/tool.tbl");
  EXPECT_EQ(resolve_ini_path("/else/tool.tbl", "/cnc/mill"), "/else/tool.tbl");
  EXPECT_EQ(resolve_ini_path("~/tool.tbl", "/cnc/mill"), "/home/me/tool.tbl");
  EXPECT_EQ(resolve_ini_path("~you/tool.tbl", "/cnc/mill"), "/cnc/mill/~you/tool.tbl");
  EXPECT_EQ(resolve_ini_path("tool.tbl", ""), "tool.tbl");
  home == nullptr ? unsetenv("HOME") : setenv("HOME", before.c_str(), 1);
}

TEST(IniInclude, FileNamesAsTheShellHasThem) {
  const auto name = [](std::string_view words) {
    const Result<std::string> result = shell_file_name(words);
    return result ? *result : "error: " + result.error();
  };
  setenv("KERF_TEST_WORD", "w", 1);
  EXPECT_EQ(name("a.inc"), "a.inc");
  EXPECT_EQ(name(" a \t b  # c"), "a b");
  EXPECT_EQ(name("a#b"), "a#b");
  EXPECT_EQ(name("'a  b'\"c  #d\""), "a  bc  #d");
  EXPECT_EQ(name("$KERF_TEST_WORD/${KERF_TEST_WORD}x'$KERF_TEST_WORD'"), "w/wx$KERF_TEST_WORD");
  EXPECT_EQ(name("\\$a\\ b \"\\$c\\d\""), "$a b $c\\d");
  EXPECT_EQ(name("'*;'\"*;\""), "*;*;");
  EXPECT_EQ(name("a;b"), "error: the shell gives ';' a meaning that is not followed here");
  EXPECT_EQ(name("\"`a`\""), "error: the shell gives '`' a meaning that is not followed here");
  for (const char* const bad : {"$1", "${A:-b}", "${A", "$", "$$"}) {
    EXPECT_EQ(name(bad), "error: the shell gives '$' a meaning that is not followed here") << bad;
  }
  EXPECT_EQ(name("it's"), "error: the quote ' is not closed");
  unsetenv("KERF_TEST_WORD");
}

TEST(IniInclude, ShellLinesKnowTheirColumns) {
  std::string_view text = "  a\\bc \t d\\ \n\n x\\\ny";
  ShellLine line = take_shell_line(text);
  EXPECT_EQ(line.text, "abc d ");
  EXPECT_EQ(line.columns, (std::vector<int>{3, 4, 6, 7, 10, 11}));
  EXPECT_EQ(line.word(), "abc");
  EXPECT_EQ(line.rest(), "d ");
  EXPECT_EQ(line.raw, "  a\\bc \t d\\ ");
  EXPECT_TRUE(line.complete);
  line = take_shell_line(text);
  EXPECT_EQ(line.text, " ");
  EXPECT_EQ(line.lines, 1);
  line = take_shell_line(text);
  EXPECT_EQ(line.text, "xy ");
  EXPECT_EQ(line.columns, (std::vector<int>{2, 0, 0}));
  EXPECT_EQ(line.lines, 2);
  EXPECT_FALSE(line.complete);
  EXPECT_TRUE(text.empty());
}

TEST(MachineLimits, OfASmallMill) {
  const MachineLimits limits = MachineLimits::small_mill();
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
    const AxisLimits& one = limits.axes[axis];
    EXPECT_EQ(one.present, axis < 6) << kAxisLetters[axis];
    EXPECT_EQ(one.max_velocity > 0 && one.max_acceleration > 0, one.present) << kAxisLetters[axis];
    EXPECT_TRUE(std::isinf(one.min) && std::isinf(one.max)) << "no soft limits";
    EXPECT_EQ(is_rotary_axis(axis), kAxisLetters[axis] >= 'A' && kAxisLetters[axis] <= 'C');
  }
  EXPECT_EQ(limits.axes[2].max_velocity, 60);
  EXPECT_EQ(limits.axes[3].max_acceleration, 360);
  EXPECT_EQ(limits.max_linear_velocity_mm_per_s, 100);
}

}  // namespace
}  // namespace kerf
