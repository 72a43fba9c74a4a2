// Holds README.md and ARCHITECTURE.md to what the program and the tree are.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Words = std::set<std::string>;

const fs::path kRoot(KERF_SOURCE_DIR);

std::string read_file(const fs::path& path) {
  std::ifstream in(path);
  EXPECT_TRUE(in) << path;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

struct CommandResult {
  int status = -1;
  std::string output;
};

/// Runs the built kerf with `arguments`; standard output only.
CommandResult run_kerf(const std::string& arguments) {
  const std::string command = "'" KERF_PROGRAM "' " + arguments + " </dev/null";
  CommandResult result;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    result.output.append(buffer.data(), n);
  }
  const int wait_status = pclose(pipe);
  if (WIFEXITED(wait_status)) result.status = WEXITSTATUS(wait_status);
  return result;
}

/// First capture of every match.
Words find_all(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  Words found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) {
    found.insert((*it)[1]);
  }
  return found;
}

/// From the heading `## title` to the next one of its kind.
std::string section(const std::string& text, const std::string& title) {
  const std::size_t begin = text.find("\n## " + title + "\n");
  EXPECT_NE(begin, std::string::npos) << "README.md has no section " << title;
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find("\n## ", begin + 1) - begin);
}

constexpr const char* kLongOption = R"((?:^|[\s,\[`(])(--[a-z][a-z0-9-]+))";

TEST(Documents, ReadmeAndHelpOfRunNameTheSameOptions) {
  const CommandResult help = run_kerf("run --help");
  ASSERT_EQ(help.status, 0);
  const Words in_help = find_all(help.output, kLongOption);
  ASSERT_TRUE(in_help.contains("--stock"));
  EXPECT_EQ(find_all(section(read_file(kRoot / "README.md"), "kerf run"), kLongOption), in_help);
}

TEST(Documents, EveryCommandThatTheReadmeNamesExists) {
  const Words commands = find_all(read_file(kRoot / "README.md"), R"((?:^|\n|`) *kerf ([a-z]+))");
  ASSERT_TRUE(commands.contains("run"));
  for (const std::string& command : commands) {
    EXPECT_EQ(run_kerf(command + " --help").status, 0) << command;
  }
}

TEST(Documents, HelpNamesTheExitCodesOfTheReadme) {
  const CommandResult help = run_kerf("--help");
  const Words in_readme =
      find_all(section(read_file(kRoot / "README.md"), "Exit codes"), R"(\n\| (\d) \| )");
  EXPECT_EQ(in_readme, (Words{"0", "1", "2", "3", "4"}));
  for (const std::string& code : in_readme) {
    EXPECT_TRUE(std::regex_search(help.output, std::regex("\\n +" + code + " +[a-z]"))) << code;
  }
}

TEST(Documents, FilesThatTheyLinkOrShowExist) {
  for (const char* document : {"README.md", "ARCHITECTURE.md"}) {
    for (const std::string& target : find_all(read_file(kRoot / document), R"(\]\(([^)#:]+)\))")) {
      EXPECT_TRUE(fs::exists(kRoot / target)) << document << " points at " << target;
    }
  }
}

TEST(Documents, NothingIsLeftToFillIn) {
  for (const char* document : {"README.md", "ARCHITECTURE.md"}) {
    EXPECT_EQ(read_file(kRoot / document).find("@@"), std::string::npos) << document;
  }
}

TEST(Documents, FoldersOfTheArchitectureExist) {
  const std::string folders = section(read_file(kRoot / "ARCHITECTURE.md"), "Folders");
  const Words named = find_all(folders, R"(\n    ([a-z_]+)/ )");
  ASSERT_TRUE(named.contains("base"));
  for (const std::string& folder : named) EXPECT_TRUE(fs::is_directory(kRoot / folder)) << folder;
}

TEST(Documents, DemoAndReadmeSayHowToGoOn) {
  const std::string demo = read_file(kRoot / "demo");
  EXPECT_NE(demo.find("kerf run YOUR.ngc"), std::string::npos);
  EXPECT_NE(demo.find("kerf view YOUR.ngc"), std::string::npos);
  EXPECT_NE(demo.find("cmake --install build/release"), std::string::npos);
  EXPECT_NE(read_file(kRoot / "README.md").find("cmake --install build/release"),
            std::string::npos);
}

TEST(Documents, ScriptsCanBeRun) {
  for (const char* script : {"demo", "check", ".ci/run", "scripts/install_packages",
                             "scripts/format_check", "tests/fuzz/run_fuzzers"}) {
    const fs::perms permissions = fs::status(kRoot / script).permissions();
    EXPECT_NE(permissions & fs::perms::owner_exec, fs::perms::none) << script;
  }
}

}  // namespace
