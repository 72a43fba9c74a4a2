// What LinuxCNC's own programs make of an INI, against IniFile: its inivar for the values, and of
// its start script the function that follows #INCLUDE.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <iostream>
#include <optional>
#include <random>

#include "interp_bridge/ini_file.h"
#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

/// What a command prints; nothing if it fails.
std::optional<std::string> output_of(const std::string& command) {
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::string text;
  std::array<char, 4096> piece;
  for (std::size_t got = 0; (got = fread(piece.data(), 1, piece.size(), pipe)) > 0;)
    text.append(piece.data(), got);
  return pclose(pipe) == 0 ? std::optional(text) : std::nullopt;
}

/// The values of a key, each in a line, as a program gets them that asks for the first, the second
/// and so on, until there is none.
std::string values_of_inivar(const std::string& path, const std::string& key) {
  const std::string ask = "inivar -ini '" + path + "' -sec A -var '" + key + "' -num ";
  std::string values;
  for (int number = 1; number < 20; ++number) {
    const auto value = output_of(ask + std::to_string(number) + " 2>/dev/null");
    if (!value) break;
    values += *value;
  }
  return values;
}

std::string values_of_kerf(IniFile& ini, const std::string& key) {
  std::string values;
  for (const IniEntry* const entry : ini.find_all("A", key)) values += entry->value + "\n";
  return values;
}

/// The INI with its includes in place, as LinuxCNC's start script makes it. Nothing if the script
/// is not there.
std::optional<std::string> expanded_by_linuxcnc(const std::string& path) {
  return output_of(
      "bash -c 'script=$(command -v linuxcnc) || exit 1; GREP=grep; "
      "eval \"$(sed -n \"/^function handle_includes/,/^}/p\" \"$script\")\"; "
      "test \"$(type -t handle_includes)\" = function && printf %s \"$(handle_includes \"$0\")\"' "
      "'" +
      path + "' 2>/dev/null");
}

class IniAsInivar : public testing::Test {
 protected:
  void SetUp() override {
    if (!output_of("command -v inivar")) GTEST_SKIP() << "LinuxCNC's inivar is not installed";
  }

  Result<IniFile> read(const std::string& text) {
    path_ = folder_.write("t.ini", text);
    diagnostics_.clear();
    return IniFile::read(path_, diagnostics_);
  }
  std::string messages() const {
    std::string text;
    for (const Diagnostic& one : diagnostics_) text += to_string(one);
    return text;
  }

  TestFolder folder_;
  std::string path_;
  Diagnostics diagnostics_;
};

std::string lines(int count, const std::string& line) {
  std::string text;
  for (int i = 0; i < count; ++i) text += line;
  return text;
}

TEST_F(IniAsInivar, ATableOfSnippets) {
  using namespace std::string_literals;
  const std::string x252(252, 'x');
  const std::vector<std::string> snippets = {
      "[A]\nK=1\n",
      "[A]\nK=1",
      " \t[A]\n\tK\t=\t1\t\n",
      "[A] K=7\nK=1\n",
      "[A]x\nK=1\n",
      "[ A ]\nK=1\n",
      "[a]\nK=1\n",
      "[A]\nk=1\n",
      "[A]]\nK=1\n",
      "[[A]]\nK=1\n",
      "[AB]\nK=1\n",
      "[A\nK=1\n",
      "A]\nK=1\n",
      "[A]\n[B\nK=1\n",
      "\v[A]\nK=1\n",
      "K=1\n[A]\n",
      "[]\nK=1\n[A]\nK=2\n",
      // keys
      "[A]\nKK=1\nK=2\n",
      "[A]\nK=1\nK=2\n[B]\nK=3\n",
      "[A]\nK=1\n[B]\n[A]\nK=2\n",
      "[B]\nK=0\n[A]\nK=2\n",
      "[A]\nK\nK=2\n",
      "[A]\nK \nK=2\n",
      "[A]\nK 1\nK=2\n",
      "[A]\nK=2\nK\t1\nK=3\n",
      "[A]\nK 1 = 3\n",
      "[A]\nK+=3\n",
      "[A]\n=3\nK=1\n",
      "[A]\nK==3\n",
      "[A]\nK[1]=3\n",
      "[A]\nK\v=1\nK=2\n",
      "[A]\nK=\nK=2\n",
      "[A]\nK=1\nK=\nK=3\n",
      "[A]\nK:1\n",
      // comments and quotes
      "[A]\n#K=1\n;K=2\n # K=3\nK=4\n",
      "[A]\nK=1 # c\n",
      "[A]\nK=1;c\n",
      "[A]\nK #=5\n",
      "#[A]\nK=1\n",
      "[A]\nK=\" 1 \"\n",
      "[A]\nK='1'\n",
      "[A]\n\"K\"=1\n",
      "[A]\nK= \v1\f \n",
      "[A]\nK=\xa0\xff\n",
      "[A]\n/K=1\n//K=1\n",
      // backslashes
      "[A]\nK=1\\\n2\n",
      "[A]\nK=1\\\n  2  \\\n3\n",
      "[A]\nK\\\nK=1\n",
      "[A]\nK\\\n=5\nK=2\n",
      "[A]\n#c\\\nK=1\n",
      "[A]\nK=1\\ \nK=2\n",
      "[A]\nK=1\\\n[A]\nK=2\n",
      "[A]\\\nK=1\n",
      "[A]\n\\\nK=1\n",
      "[A]\nK=1\\",
      "[A]\nK=1\\\n",
      "[A]\nK=1\\\\\n2\n",
      "[A]\nK=1\\\n23",
      "[A]\nK=1\\x",
      "#c\\\n[A]\nK=1\n",
      "[B]\nK=2\\\n[A]\nK=1\n",
      "[A]\nK=" + lines(20, "1\\\n") + "2\n",
      "[A]\nK=" + lines(20, std::string(200, '1') + "\\\n") + "2\n",
      // carriage returns
      "[A]\r\nK=1\r\nK=2\r\n",
      "[A]\nK=1\r",
      "[A]\nK\r\nK=1\n",
      "[A]\nK=1\\\r\nK=2\n",
      "[A]\nK=1\\\n2\r\n",
      "[A]\nK=1\n\r\nK=2\n",
      // long lines
      "[A]\nK=" + x252 + "\nK=1\n",
      "[A]\nK=" + x252 + "y\nK=1\n",
      "[A]\nK=" + x252 + "yz\nK=1\n",
      "[A]\nK=" + x252 + "yK=2\nK=1\n",
      "[A]\nK=" + x252 + "\\\n2\nK=1\n",
      "[A]\nK=" + x252 + "\\y\nK=1\n",
      "[A]\nK=" + x252 + "\\\\\n2\nK=1\n",
      "[A]\n##" + x252 + "y[A]\nK=1\n",
      "##" + x252 + "y[A]\nK=1\n",
      "[A]\nK=1\\\n" + x252 + "12345\nK=1\n",
      "[A]\nK=" + x252 + "\r\nK=1\r\n",
      "[A]\nK=" + x252 + "y\r\nK=1\r\n",
      "[A]\nK=" + std::string(900, 'y') + "\nK=1\n",
      "\xef\xbb\xbf[A]\nK=1\n",
      "\xef\xbb\xbf\n[A]\nK=1\n",
      "[A]\n\xef\xbb\xbfK=1\n",
      "",
      "\n",
  };
  std::size_t with_values = 0;
  for (const std::string& snippet : snippets) {
    Result<IniFile> ini = read(snippet);
    ASSERT_TRUE(ini) << ini.error();
    const std::string expected = values_of_inivar(path_, "K");
    EXPECT_EQ(values_of_kerf(*ini, "K"), expected) << testing::PrintToString(snippet);
    EXPECT_FALSE(has_error(diagnostics_)) << messages();
    with_values += expected.empty() ? 0 : 1;
  }
  EXPECT_GT(with_values, snippets.size() / 2);
}

/// Where IniFile knowingly answers otherwise.
TEST_F(IniAsInivar, KnownDifferences) {
  struct Difference {
    std::string snippet;
    std::string inivar;
    std::string kerf;
    bool is_error;  ///< no run comes of it
    const char* why;
  };
  using namespace std::string_literals;
  const std::vector<Difference> differences = {
      {"[A]\nJ=1\rI=2\nK=3\n", "", "3\n", true,
       "inivar stops at a carriage return; all faults of the file are to be told at once"},
      {"[A]\nJ=" + lines(21, "1\\\n") + "2\nK=3\n", "", "3\n", true, "the same, 20 joined lines"},
      {"[A]\nK=1\0 2\n"s, "1\n", "", true, "inivar drops what follows a byte of value 0"},
      {"[A]\nI=1\\\n[B]\nK=2\n", "2\n", "", false,
       "to inivar [B] begins, and [A] goes on, behind a backslash; a key has one section here"},
  };
  for (const Difference& one : differences) {
    Result<IniFile> ini = read(one.snippet);
    ASSERT_TRUE(ini) << ini.error();
    EXPECT_EQ(values_of_inivar(path_, "K"), one.inivar) << one.why;
    EXPECT_EQ(values_of_kerf(*ini, "K"), one.kerf) << one.why;
    EXPECT_FALSE(diagnostics_.empty()) << one.why;
    EXPECT_EQ(has_error(diagnostics_), one.is_error) << messages();
  }
}

/// Words of INIs in random order. The known differences are left out.
TEST_F(IniAsInivar, RandomTexts) {
  const std::vector<std::string> words = {"[A]",
                                          "[B]",
                                          "[A",
                                          "]",
                                          "K",
                                          "KK",
                                          "K=",
                                          "K = 2",
                                          "=",
                                          " ",
                                          "\t",
                                          "\n",
                                          "\n",
                                          "\n",
                                          "\\\n",
                                          "\\",
                                          "#",
                                          ";",
                                          "\"",
                                          "v",
                                          "\nK=3\n",
                                          "\nKK=9\n",
                                          "\n[A]\n",
                                          "\n[B]\n",
                                          "\nK 5\n",
                                          "\r\n",
                                          std::string(120, 'y'),
                                          std::string(254, 'z')};
  constexpr unsigned kSeed = 20230208;
  std::mt19937 random(kSeed);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    std::string text = i % 4 == 0 ? "" : "[A]\n";
    for (auto count = 1 + random() % 10; count > 0; --count) text += words[random() % words.size()];
    Result<IniFile> ini = read(text);
    ASSERT_TRUE(ini) << ini.error();
    if (has_error(diagnostics_) || messages().find("joins this section") != std::string::npos)
      continue;
    ++compared;
    for (const char* const key : {"K", "KK"}) {
      EXPECT_EQ(values_of_kerf(*ini, key), values_of_inivar(path_, key))
          << "seed " << kSeed << ", text " << i << ": " << testing::PrintToString(text);
    }
  }
  EXPECT_GT(compared, 200);
}

TEST_F(IniAsInivar, IncludesAsTheStartScriptHasThem) {
  folder_.write("a.inc", "K=1\n");
  folder_.write("unended.inc", "K=2");
  folder_.write("c d.inc", "K=3\n[B]\nK=4\n");
  folder_.write("deep.inc", "#INCLUDE a.inc\nK=5\n");
  folder_.write("joins.inc", "K=6\\\n");
  folder_.write("dos.inc", "K=7\r\n");
  const std::vector<std::string> snippets = {
      "[A]\n#INCLUDE a.inc\nK=9\n",
      "[A]\n  #INCLUDE a.inc\nK=9\n",
      "[A]\n  #INCLUDE a.inc\n#INCLUDE a.inc\n",
      "[A]\n#INCLUDEX\n  #INCLUDE a.inc\nK=9\n",
      "[A]\n#INCLUDE unended.inc\nK=9\n",
      "[A]\n#INCLUDE c\\ d.inc\n[A]\nK=9\n",
      "[A]\n#INCLUDE \"c d.inc\"\n",
      "[A]\n#INCLUDE c  d.inc # two blanks\n",
      "[A]\n#INCLUDE c\\ \\ d.inc\n",
      "[A]\n#INCLUDE 'c  d.inc'\n",
      "[A]\n#INCLUDE deep.inc\n",
      "[A]\n#INCLUDE joins.inc\nK=9\n",
      "[A]\n#INCLUDE dos.inc\nK=9\n",
      "[A]\n#INCLUDE t.ini\nK=9\n",
      "[A]\n#INCLUDE no.inc\nK=9\n",
      "[A]\n#INCLUDE\nK=9\n",
      "[A]\n#INCLUDE $KERF_TEST_NIX\nK=9\n",
      "[A]\n#INCLUDE ./$KERF_TEST_NAME.inc\n#INCLUDE ${KERF_TEST_NAME}.inc\n",
      "[A]\n#INCLUDE '$KERF_TEST_NAME.inc'\nK=9\n",
      "[A]\n#INCLUDE \\\na.inc\nK=9\n",
      "[A]\n#INCLUDE a.inc\nK=1\\\n  2\nK=C:\\dir\\\\on\n",
      "[A]\n#INCLUDE a.inc\nK=1\\\\\n2\nK=3\n",
      "[A]\nK=1\\\\\n#INCLUDE a.inc\n",
      "[A]\nK=1\\\n#INCLUDE a.inc\n",
      "[A]\n#INCLUDE a.inc\nK=9",
      "[A]\n#INCLUDE a.inc\nK \nK=9\n",
      "[A]\n#INCLUDE a.inc\nK\nK=9\n",
      "\\#INCLUDE a.inc\n[A]\nK=9\n",
      "#INCLUDE a.inc\n \\[A]\n\\K=9\n",
      "[A]\n#INCLUDE a.inc\\\\\nK=9\n",
      "[A]\n#INCLUDE ~/a.inc\nK=9\n"};
  setenv("KERF_TEST_NAME", "a", 1);
  for (const std::string& snippet : snippets) {
    Result<IniFile> ini = read(snippet);
    ASSERT_TRUE(ini) << ini.error();
    const std::optional<std::string> expanded = expanded_by_linuxcnc(path_);
    if (!expanded) GTEST_SKIP() << "LinuxCNC's start script is not installed";
    EXPECT_EQ(values_of_kerf(*ini, "K"), values_of_inivar(*expanded, "K"))
        << testing::PrintToString(snippet) << messages();
    // And so does what is read from the text that the interpreter is given.
    if (ini->expanded_text().empty()) continue;
    const std::string given = folder_.write("given.ini", ini->expanded_text());
    EXPECT_EQ(values_of_kerf(*ini, "K"), values_of_inivar(given, "K"))
        << testing::PrintToString(snippet);
  }
  unsetenv("KERF_TEST_NAME");
}

/// Of every sample configuration the first, the middle and the last key.
TEST_F(IniAsInivar, SamplesOfLinuxcnc) {
  const fs::path samples = "/usr/share/doc/linuxcnc/examples/sample-configs";
  if (!fs::is_directory(samples)) GTEST_SKIP() << "no sample configurations of LinuxCNC";
  std::size_t compared = 0;
  for (const auto& file : fs::recursive_directory_iterator(samples)) {
    if (file.path().extension() != ".ini" || !file.is_regular_file()) continue;
    Diagnostics diagnostics;
    Result<IniFile> ini = IniFile::read(file.path().string(), diagnostics);
    ASSERT_TRUE(ini) << ini.error();
    const std::size_t count = ini->entries().size();
    if (!ini->expanded_text().empty() || count == 0) continue;
    for (const std::size_t index : {std::size_t{0}, count / 2, count - 1}) {
      const std::string section = ini->entries()[index].section;
      const std::string key = ini->entries()[index].key;
      const auto expected = output_of("inivar -ini '" + file.path().string() + "' -sec '" +
                                      section + "' -var '" + key + "' 2>/dev/null");
      const IniEntry* const entry = ini->find(section, key);
      EXPECT_EQ(entry == nullptr ? "none" : entry->value + "\n", expected.value_or("none"))
          << file.path() << " [" << section << "]" << key;
      ++compared;
    }
  }
  EXPECT_GT(compared, 500U);
  std::cout << compared << " values compared\n";
}

}  // namespace
}  // namespace kerf
