// The parts of a batch by themselves: lists of programs, tables of options, results as lines.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/base/temporary_folder.h"
#include "twin/batch/batch_pages.h"
#include "twin/batch/batch_result.h"
#include "twin/batch/called_files.h"
#include "twin/batch/content_hash.h"
#include "twin/batch/option_table.h"
#include "twin/batch/result_log.h"
#include "twin/batch/work_list.h"
#include "twin/report/finding_lists.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

class BatchParts : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text = "M2\n") {
    const fs::path path = fs::path(folder_.path()) / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }
  std::string at(const std::string& name) const { return folder_.path() + "/" + name; }
  Texts programs(const Texts& what) { return programs_of(what, told_); }
  /// "list.txt:2: no such file": the file by its name alone.
  Texts told() const {
    Texts all;
    for (const Diagnostic& d : told_) {
      all.push_back(fs::path(d.file).filename().string() + ":" + std::to_string(d.line) + ": " +
                    d.message.substr(d.message.rfind('/') + 1));
    }
    return all;
  }
  TemporaryFolder folder_;
  Diagnostics told_;
};

TEST_F(BatchParts, AFolderGivesItsProgramsSortedAndNoHiddenOnes) {
  write("parts/b.NGC");
  write("parts/a/z.nc");
  write("parts/readme.txt");
  write("parts/.git/c.ngc");
  write("parts/.d.ngc");
  EXPECT_EQ(programs({at("parts")}), (Texts{at("parts/a/z.nc"), at("parts/b.NGC")}));
  EXPECT_EQ(told(), Texts{});
}

TEST_F(BatchParts, AListIsReadFromItsFolderAndEachProgramComesOnce) {
  write("parts/a.ngc");
  write("parts/b.tap");
  const std::string list = write("list.txt", "# ours\n\nparts/b.tap\r\n  parts\nparts/*.ngc\n");
  EXPECT_EQ(programs({list, at("parts/a.ngc")}), (Texts{at("parts/b.tap"), at("parts/a.ngc")}));
  EXPECT_EQ(told(), Texts{});
}

TEST_F(BatchParts, WhatIsMissingInAListIsToldAtItsLineAllAtOnce) {
  write("a.ngc");
  write("empty/readme.txt");
  const std::string list =
      write("list.txt", "a.ngc\ngone.ngc\nempty\n*.nc\nempty/readme.txt\nb.ngc\n");
  EXPECT_EQ(programs({list}), (Texts{at("a.ngc"), at("empty/readme.txt")}));
  EXPECT_EQ(told(), (Texts{"list.txt:2: gone.ngc: no such file or folder",
                           "list.txt:3: empty: no program in this folder",
                           "list.txt:4: *.nc: no program fits this pattern",
                           "list.txt:6: b.ngc: no such file or folder"}));
}

TEST_F(BatchParts, ATableOfOptionsAddsUpAndTheLaterLineCounts) {
  const std::vector<OptionRow> rows = parse_option_table(
      "# tools\n*: --cell 0.2 --tool 1=flat:6\nparts/*.ngc: --cell=0.05 --tool '2=ball:3' "
      "--no-guess\nother.ngc: --cell 1\n",
      "t.txt", told_);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(told(), Texts{});
  WrittenOptions options;
  options.set("--cell", "0.5");
  for (const OptionRow& row : rows) {
    if (fits(row, "work/parts/a.ngc")) apply(row, options);
  }
  const Texts words = run_words(options);
  EXPECT_EQ(Texts(words.begin(), words.end()).size(), 4U);
  for (const char* word : {"--cell=0.05", "--tool=1=flat:6", "--tool=2=ball:3", "--no-guess"}) {
    EXPECT_EQ(std::count(words.begin(), words.end(), word), 1) << word;
  }
  EXPECT_FALSE(fits(rows[1], "partsa.ngc"));
  EXPECT_FALSE(fits(rows[2], "another.ngc"));
}

TEST_F(BatchParts, FaultsOfATableHaveLineAndColumn) {
  EXPECT_TRUE(parse_option_table("--cell 0.1\na.ngc:\na.ngc: --cel 1\na.ngc: --cell\n"
                                 "a.ngc: --tool '1=flat\na.ngc: --json r.json\n"
                                 "a.ngc: --no-guess=1\n",
                                 "t.txt", told_)
                  .empty());
  ASSERT_EQ(told_.size(), 7U);
  const int columns[] = {1, 6, 8, 8, 15, 8, 8};
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(told_[i].line, i + 1);
    EXPECT_EQ(told_[i].column, columns[i]) << told_[i].message;
  }
  EXPECT_EQ(told_[2].message, "--cel: no option that a batch passes on; did you mean --cell?");
  EXPECT_EQ(told_[5].message, "--json: no option that a batch passes on");
}

BatchResult result_named(const std::string& program) {
  BatchResult r;
  r.program = program;
  r.hash = "0123";
  r.verdict = BatchVerdict::kFindings;
  r.exit_code = 1;
  r.errors = 2;
  r.findings = 3;
  r.time_s = 12.5;
  r.digest = "d1";
  r.message = "line 4: \"deep\"\n\xff";
  r.bounds = {60, 0};
  return r;
}

TEST_F(BatchParts, ResultsThatAreCutAtAnyByteLoseTheLastOneAtMost) {
  std::string text;
  std::vector<std::size_t> ends;
  for (const char* name : {"a.ngc", "b.ngc", "c.ngc"}) {
    text += line_of(result_named(name));
    ends.push_back(text.size());
  }
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    const std::size_t whole =
        static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), cut) - ends.begin());
    bool damaged = false;
    const std::vector<BatchResult> got = parse_results(text.substr(0, cut), damaged);
    ASSERT_EQ(got.size(), whole) << cut;
    const bool at_end = cut == 0 || std::find(ends.begin(), ends.end(), cut) != ends.end();
    ASSERT_EQ(damaged, !at_end) << cut;
    for (const BatchResult& one : got) ASSERT_EQ(line_of(one).size(), ends[0]);
  }
  bool damaged = false;
  const auto again = parse_results(text + "garbage\n" + line_of(result_named("a.ngc")), damaged);
  EXPECT_EQ(again.size(), 3U);
  EXPECT_TRUE(damaged);
  EXPECT_EQ(again[0].time_s, 12.5);
  EXPECT_EQ(again[0].verdict, BatchVerdict::kFindings);
}

TEST_F(BatchParts, TheHashKnowsWhatARunDependsOn) {
  const std::string program = write("a.ngc", "O<sub> CALL [1]\nM2\n");
  write("sub.ngc", "O<sub> sub\nO<sub> endsub\n");
  const std::string ini = write("mill.ini", "[EMCIO]\nTOOL_TABLE = tool.tbl\n");
  write("tool.tbl", "T1 P1 D6\n");
  const Texts words{"--ini=" + ini, "--cell=0.1"};
  const std::string hash = content_hash(program, words);
  EXPECT_EQ(hash.size(), 32U);
  EXPECT_EQ(content_hash(program, words), hash);
  EXPECT_NE(content_hash(program, {"--ini=" + ini, "--cell=0.2"}), hash);
  Texts seen{hash};
  for (const auto& [name, text] :
       {std::pair("a.ngc", "O<sub> CALL [2]\nM2\n"), std::pair("sub.ngc", "O<sub> sub\nG4 P1\n"),
        std::pair("mill.ini", "[EMCIO]\nTOOL_TABLE = tool.tbl\n#\n"),
        std::pair("tool.tbl", "T1 P1 D8\n")}) {
    write(name, text);
    const std::string now = content_hash(program, words);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), now), 0) << name;
    seen.push_back(now);
  }
  write("bystander.ngc");
  EXPECT_EQ(content_hash(program, words), seen.back());
}

TEST_F(BatchParts, SubroutinesOfOtherFoldersAndRemapsChangeTheHash) {
  const std::string program = write("parts/a.ngc", "N10 o <Drill> call [1]\nm98 p100\nM2\n");
  write("subs/drill.ngc", "o<drill> sub\n/ o<deep> call\no<drill> endsub\n");
  write("more/deep.ngc", "o<deep> sub\no<deep> endsub\n");
  write("more/100.ngc", "o100 sub\no100 endsub\n");
  write("more/change.ngc", "o<change> sub\no<change> endsub\n");
  write("more/other.ngc", "o<other> sub\no<other> endsub\n");
  write("common.inc", "[EMCIO]\nTOOL_TABLE = tool.tbl\n");
  write("tool.tbl", "T1 P1 D6\n");
  write("mill.ini",
        "#INCLUDE common.inc\n[RS274NGC]\nSUBROUTINE_PATH = subs:more\n"
        "REMAP = M6 modalgroup=6 ngc=change\n");
  const Texts words{"--config=" + write("kerf.yaml", "machine:\n  ini: mill.ini\n")};
  Texts seen{content_hash(program, words)};
  EXPECT_EQ(content_hash(program, {"--ini=" + at("mill.ini")}).size(), 32U);
  for (const char* name : {"subs/drill.ngc", "more/deep.ngc", "more/100.ngc", "more/change.ngc",
                           "common.inc", "tool.tbl", "mill.ini"}) {
    std::ofstream(at(name), std::ios::app) << "(another)\n";
    const std::string now = content_hash(program, words);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), now), 0) << name;
    seen.push_back(now);
  }
  // What nobody calls does not count; what is called and was not there yet does.
  write("more/other.ngc", "o<other> sub\nG4 P1\no<other> endsub\n");
  EXPECT_EQ(content_hash(program, words), seen.back());
  write("subs/100.ngc", "o100 sub\no100 endsub\n");
  EXPECT_NE(content_hash(program, words), seen.back());
}

TEST_F(BatchParts, CallsAreFoundAsLinuxCncReadsThem) {
  EXPECT_EQ(called_names("o<a> call\nO <Big One> CALL [1] [2]\n(o<b> call) ; o<c> call\n"
                         "o<d> sub\n/N5 o7 call\nG1 M98 P1001 L2\no[#1] call\nM98\n"),
            (Texts{"a", "BigOne", "bigone", "7", "1001"}));
}

TEST_F(BatchParts, ListsOfRunsAreJoinedToTheListOfAll) {
  ListedProgram good, bad;
  good.path = "a.ngc";
  good.total_s = 1.5;
  bad.path = "b.ngc";
  bad.partial_reason = "no <tool>";
  const ListedProgram both[]{good, bad};
  const Texts single{junit_text(std::span(&good, 1), "1"), junit_text(std::span(&bad, 1), "1")};
  EXPECT_EQ(join_junit(single, "1"), junit_text(both, "1"));
  EXPECT_EQ(join_junit(Texts{single[0], single[1].substr(0, single[1].size() - 1)}, "1"),
            std::nullopt);
  BatchEnd end;
  end.results = {result_named("gone.ngc")};
  const std::string text = batch_junit(end, folder_.path(), "1");
  EXPECT_NE(text.find("tests=\"1\" failures=\"0\" errors=\"1\""), text.npos) << text;
}

TEST_F(BatchParts, FoldersOfProgramsAreDifferentAndStay) {
  EXPECT_EQ(folder_of("a/slot.ngc"), folder_of("a/slot.ngc"));
  EXPECT_NE(folder_of("a/slot.ngc"), folder_of("b/slot.ngc"));
  EXPECT_TRUE(folder_of("a/../x y.ngc").starts_with("programs/x-y-"));
}

}  // namespace
}  // namespace kerf
