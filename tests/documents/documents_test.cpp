// Holds README.md, docs/ and their neighbours to what the program and the tree are. What their
// commands print is looked at by run_documents.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
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

/// From the heading `## title` of a document to the next one of its kind.
std::string section(const std::string& document, const std::string& title) {
  const std::string text = read_file(kRoot / document);
  const std::size_t begin = text.find("\n## " + title + "\n");
  EXPECT_NE(begin, std::string::npos) << document << " has no section " << title;
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find("\n## ", begin + 1) - begin);
}

/// README.md and its neighbours, docs/, examples/.
std::vector<std::string> documents() {
  std::vector<std::string> names{"README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md"};
  for (const char* folder : {"docs", "examples"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      if (entry.path().extension() != ".md") continue;
      names.push_back(fs::relative(entry.path(), kRoot).generic_string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> lines_of(const std::string& document) {
  std::istringstream text(read_file(kRoot / document));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

std::size_t characters(const std::string& utf8) {
  return static_cast<std::size_t>(std::count_if(
      utf8.begin(), utf8.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

constexpr const char* kLongOption = R"((?:^|[\s,\[`(])(--[a-z][a-z0-9-]+))";
const char* const kCommands[] = {"run",   "view",   "shadow", "replay",   "canon",
                                 "setup", "config", "tools",  "models",   "sources",
                                 "diff",  "batch",  "job",    "optimize", "mcp"};

Words options_of(const std::string& command) {
  const CommandResult help = run_kerf(command + " --help");
  EXPECT_EQ(help.status, 0) << command;
  return find_all(help.output, kLongOption);
}

TEST(Documents, DryRunAndHelpOfRunNameTheSameOptions) {
  const Words in_help = options_of("run");
  ASSERT_TRUE(in_help.contains("--stock"));
  EXPECT_EQ(find_all(section("docs/dry-run.md", "Options"), kLongOption), in_help);
}

/// Those of `kerf run` are not told again.
TEST(Documents, TheWindowsOptionsAreThoseOfHelp) {
  Words wanted = options_of("view"), of_run = options_of("run");
  const Words told = find_all(section("docs/window.md", "Options"), kLongOption);
  for (const std::string& option : told) EXPECT_TRUE(wanted.contains(option)) << option;
  for (const std::string& option : wanted) {
    EXPECT_TRUE(told.contains(option) || of_run.contains(option)) << option;
  }
}

TEST(Documents, EveryOptionIsExplainedSomewhereAndNoneIsInvented) {
  Words known{"--version"}, told;
  for (const char* command : kCommands) known.merge(options_of(command));
  std::string of_others =
      read_file(kRoot / "scripts/format_check") + read_file(kRoot / "tests/truth/run_truth") +
      read_file(kRoot / "check") + read_file(kRoot / "examples/ci/kerf.yml") +
      read_file(kRoot / "examples/ci/pre-commit") + read_file(kRoot / "scripts/make_packages") +
      read_file(kRoot / "scripts/check_platforms") +
      read_file(kRoot / "scripts/update_translations") +
      read_file(kRoot / "configs/vismach_links") +
      read_file(kRoot / "tests/twin/compare/planted/run_planted");
  of_others += run_kerf("machine --help").output + " --build --preset --workflow --install ";
  const Words foreign = find_all(of_others, R"((--[a-z][a-z-]+))");
  for (const std::string& document : documents()) {
    if (document == "ARCHITECTURE.md") continue;  // its arrows look like options, and it has none
    for (const std::string& option : find_all(read_file(kRoot / document), kLongOption)) {
      EXPECT_TRUE(known.contains(option) || foreign.contains(option)) << document << ' ' << option;
      told.insert(option);
    }
  }
  for (const std::string& option : known) EXPECT_TRUE(told.contains(option)) << option;
}

/// "\-" as it is read.
std::string without_escapes(std::string manual) {
  for (std::size_t at = 0; (at = manual.find("\\-", at)) != manual.npos;) manual.erase(at, 1);
  return manual;
}

/// In the order in which the shells see them: of each command its own.
TEST(Documents, EveryOptionOfHelpStandsInTheManualAndInTheCompletions) {
  const std::string bash = run_kerf("config completion bash").output;
  const std::string zsh = run_kerf("config completion zsh").output;
  // Between "  run)" and the next command.
  const auto part = [](const std::string& script, const std::string& command) {
    const std::size_t begin = script.rfind("\n  " + command + ")\n");
    EXPECT_NE(begin, std::string::npos) << command;
    return script.substr(begin, script.find("\n    ;;\n", begin) - begin);
  };
  std::vector<std::string> commands(std::begin(kCommands), std::end(kCommands));
  commands.emplace_back("machine");
  for (const std::string& command : commands) {
    Words options = find_all(run_kerf(command + " --help").output, R"(\n +(?:-.,)?(--[a-z-]+))");
    options.erase("--version");
    EXPECT_TRUE(options.contains("--help")) << command;
    const Words in_bash = find_all(part(bash, command), R"([ '](--[a-z-]+))");
    const Words in_zsh = find_all(part(zsh, command), R"((?:[,'*])(--[a-z-]+)[\['}])");
    EXPECT_EQ(in_bash, options) << command;
    EXPECT_EQ(in_zsh, options) << command;
    const std::string manual = without_escapes(run_kerf("config man kerf-" + command).output);
    EXPECT_NE(manual.find("kerf-" + command + " - "), std::string::npos);
    for (const std::string& option : options) {
      if (option == "--help") continue;
      EXPECT_NE(manual.find("\\fB" + option + "\\fR"), std::string::npos) << option;
    }
  }
}

TEST(Documents, EveryKeyStandsInTheManual) {
  const std::string schema = run_kerf("config schema").output;
  const std::string manual = without_escapes(run_kerf("config man").output);
  ASSERT_GT(schema.size(), 1000u);
  EXPECT_NE(manual.find(schema), std::string::npos);
}

TEST(Documents, EveryCommandThatTheyNameExists) {
  Words commands;
  for (const std::string& document : documents()) {
    commands.merge(find_all(read_file(kRoot / document), R"((?:^|\n|`) *kerf ([a-z]+))"));
  }
  ASSERT_TRUE(commands.contains("run"));
  for (const std::string& command : commands) {
    EXPECT_EQ(run_kerf(command + " --help").status, 0) << command;
  }
  for (const char* command : kCommands) EXPECT_TRUE(commands.contains(command)) << command;
}

TEST(Documents, HelpNamesTheExitCodesOfTheDocuments) {
  const CommandResult help = run_kerf("--help");
  const Words told = find_all(section("docs/dry-run.md", "Exit codes"), R"(\n\| (\d) \| )");
  EXPECT_EQ(told, (Words{"0", "1", "2", "3", "4"}));
  for (const std::string& code : told) {
    EXPECT_TRUE(std::regex_search(help.output, std::regex("\\n +" + code + " +[a-z]"))) << code;
  }
}

/// The id of each row of the table of findings, with its severities.
std::map<std::string, std::string> told_findings() {
  std::map<std::string, std::string> rows;
  const std::regex row(R"(\n\| `([a-z-]+)` \| ([^|]+) \| ([^|]+) \| ([^|]*) \|)");
  const std::string table = section("docs/report-and-findings.md", "All findings");
  for (std::sregex_iterator it(table.begin(), table.end(), row), end; it != end; ++it) {
    EXPECT_TRUE(rows.emplace((*it)[1], (*it)[2]).second) << (*it)[1] << " has two rows";
  }
  return rows;
}

TEST(Documents, TheTableOfFindingsHasThoseOfTheSource) {
  const Words known = find_all(read_file(kRoot / "twin/findings/finding_table.cpp"),
                               R"re(Id::\w+,\s+"([a-z-]+)")re");
  ASSERT_TRUE(known.contains("rapid-contact"));
  Words told;
  for (const auto& [id, severity] : told_findings()) told.insert(id);
  EXPECT_EQ(told, known);
}

/// What programs worked out by hand are told (tests/truth) is in the table with that severity.
TEST(Documents, TheTableOfFindingsHasTheirSeverities) {
  const std::map<std::string, std::string> told = told_findings();
  const std::regex finding(R"((?:^|\n)(?:text: |bridge: )?finding: ([a-z-]+) ([a-z]+) )");
  int compared = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / "tests/truth")) {
    if (entry.path().extension() != ".truth") continue;
    const std::string text = read_file(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), finding), end; it != end; ++it) {
      const auto row = told.find((*it)[1]);
      ASSERT_NE(row, told.end()) << (*it)[1];
      EXPECT_NE(row->second.find((*it)[2]), std::string::npos) << entry.path() << ' ' << (*it)[0];
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(Documents, TheKeysOfTheWindowAreThoseOfTheSource) {
  const Words known =
      find_all(read_file(kRoot / "viewer/window/shortcuts.cpp"), R"re(Shortcut\{"([^"]+)")re");
  ASSERT_TRUE(known.contains("Space"));
  Words told;
  const std::regex key("`([^`]+)`");
  for (const std::string& line : lines_of("docs/window.md")) {
    if (line.empty() || line[0] != '|') continue;
    for (std::sregex_iterator it(line.begin(), line.end(), key), end; it != end; ++it) {
      told.insert((*it)[1]);
    }
  }
  for (const char* view : {"2", "3", "4", "5"}) told.insert(view);  // `1` to `6`
  EXPECT_EQ(told, known);
}

TEST(Documents, TheShapesAreThoseOfKerfTools) {
  const Words known = find_all(run_kerf("tools").output, R"((?:^|\n)([a-z]+:[A-Z][^ ]*) )");
  ASSERT_TRUE(known.contains("flat:D"));
  Words told =
      find_all(section("docs/tools-and-blanks.md", "Shapes of tools"), R"(\n\| `([^`]+)`)");
  told.merge(find_all(read_file(kRoot / "docs/turning-tools.md"), R"(\n\| `([a-z]+:[^`]+)`)"));
  EXPECT_EQ(told, known);
}

/// The anchor that a heading has on a page: in small letters, without signs, - for blanks.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    if (c == ' ' || c == '-') {
      anchor += '-';
    } else if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return anchor;
}

Words anchors_of(const std::string& document) {
  Words anchors;
  bool in_block = false;
  for (const std::string& line : lines_of(document)) {
    if (line.starts_with("```")) in_block = !in_block;
    const std::size_t begin = line.find_first_not_of('#');
    if (in_block || begin == 0 || begin == std::string::npos || line[begin] != ' ') continue;
    anchors.insert(anchor_of(line.substr(begin + 1)));
  }
  return anchors;
}

TEST(Documents, WhatTheyLinkOrShowExists) {
  std::vector<std::string> pages = documents();
  for (const char* folder : {"configs/linuxcnc", "interp_bridge/kerf_interp", "machine_io",
                             "machine_io/hal", "machine_io/simulator"}) {
    pages.push_back(std::string(folder) + "/README.md");
  }
  for (const std::string& document : pages) {
    // A link's words may go over the end of a line, its target does not.
    for (const std::string& link : find_all(read_file(kRoot / document), R"(\]\(([^) ]+)\))")) {
      if (link.starts_with("http")) continue;
      const std::size_t mark = link.find('#');
      const std::string path = link.substr(0, mark);
      const fs::path target =
          path.empty() ? fs::path(document) : (fs::path(document).parent_path() / path);
      ASSERT_TRUE(fs::exists(kRoot / target)) << document << " points at " << link;
      if (mark == std::string::npos) continue;
      EXPECT_TRUE(anchors_of(target.generic_string()).contains(link.substr(mark + 1)))
          << document << " points at " << link;
    }
  }
}

TEST(Documents, EachPageIsFoundFromTheReadme) {
  const Words links = find_all(read_file(kRoot / "README.md"), R"(\]\(([^)#]+))");
  for (const std::string& document : documents()) {
    EXPECT_TRUE(document == "README.md" || links.contains(document)) << document;
  }
}

TEST(Documents, LinesAreShort) {
  EXPECT_LE(lines_of("README.md").size(), 150u);
  for (const std::string& document : documents()) {
    int number = 0;
    for (const std::string& line : lines_of(document)) {
      ++number;
      const bool is_table = line.starts_with("|") && document != "README.md";
      EXPECT_TRUE(is_table || characters(line) <= 100) << document << ':' << number;
    }
  }
}

TEST(Documents, NothingIsLeftToFillIn) {
  for (const std::string& document : documents()) {
    for (const char* mark : {"@@", "TODO", "FIXME"}) {
      EXPECT_EQ(read_file(kRoot / document).find(mark), std::string::npos) << document;
    }
  }
}

TEST(Documents, FoldersOfTheArchitectureExist) {
  const Words named = find_all(section("ARCHITECTURE.md", "Folders"), R"(\n    ([a-z_]+)/ )");
  ASSERT_TRUE(named.contains("base"));
  for (const std::string& folder : named) EXPECT_TRUE(fs::is_directory(kRoot / folder)) << folder;
}

TEST(Documents, FilesThatContributorsAreSentToExist) {
  const Words named = find_all(read_file(kRoot / "CONTRIBUTING.md"),
                               R"(`((?:[a-z_]+/)+[a-z_]*(?:\.(?:cpp|h|txt|yaml))?)`)");
  ASSERT_GT(named.size(), 40u);
  for (const std::string& path : named) EXPECT_TRUE(fs::exists(kRoot / path)) << path;
}

TEST(Documents, VersionsOfFormatsAreThoseOfTheSources) {
  const std::string told = section("docs/report-and-findings.md", "Versions of formats");
  const std::pair<const char*, const char*> sources[] = {
      {"twin/report/report_json.cpp", R"re("(kerf-report/\d+)")re"},
      {"twin/batch/batch_pages.cpp", R"re("(kerf-batch/\d+)")re"},
      {"twin/cli/job_text.cpp", R"re("(kerf-job/\d+)")re"},
      {"machine_io/recording_format.h", R"re("# (kerf-recording/\d+)")re"},
      {"stock/state_bytes.h", R"re("(kerf-state/\d+)\\n")re"}};
  for (const auto& [source, pattern] : sources) {
    const Words written = find_all(read_file(kRoot / source), pattern);
    ASSERT_EQ(written.size(), 1u) << source;
    EXPECT_NE(told.find('`' + *written.begin() + '`'), std::string::npos) << *written.begin();
  }
}

TEST(Documents, VersionSaysWhichBuildItIs) {
  const CommandResult said = run_kerf("--version");
  EXPECT_EQ(said.status, 0);
  EXPECT_TRUE(std::regex_match(
      said.output, std::regex("kerf " KERF_PROJECT_VERSION R"(( \(git [A-Za-z0-9._-]+\))?\n)")))
      << said.output;
  // Of a clone that is somebody else's git says nothing.
  const bool is_clone = fs::exists(kRoot / ".git") && KERF_HAS_GIT &&
                        std::system("git -C '" KERF_SOURCE_DIR
                                    "' describe --always "
                                    ">/dev/null 2>&1") == 0;
  EXPECT_EQ(said.output.find("(git ") != std::string::npos, is_clone) << said.output;
  const std::string changes = read_file(kRoot / "CHANGELOG.md");
  EXPECT_NE(changes.find(KERF_PROJECT_VERSION), std::string::npos);
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
  for (const char* script :
       {"demo", "check", ".ci/run", "scripts/install_packages", "scripts/format_check",
        "scripts/write_reference", "tests/fuzz/run_fuzzers", "tests/documents/run_documents"}) {
    const fs::perms permissions = fs::status(kRoot / script).permissions();
    EXPECT_NE(permissions & fs::perms::owner_exec, fs::perms::none) << script;
  }
}

}  // namespace
