#include "interp_bridge/program_prepare.h"

#include <gtest/gtest.h>

#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

std::string numbered(std::string_view text, std::uint32_t file = 0) {
  LineNumberer numberer(file);
  std::string out;
  numberer.append(text, out);
  return out;
}

TEST(LineNumberer, ReplacesTheOldNumber) {
  EXPECT_EQ(numbered("G0 X1\nN100 G1 Y2\nn0042g3\nN 12 G0 X2\nN3.5 G0 X4\n  N13 G0 X9\nN11\n"),
            "N1G0 X1\nN2G1 Y2\nN3g3\nN4G0 X2\nN5G0 X4\nN6G0 X9\nN7\n");
}

TEST(LineNumberer, KeepsTheBlockDeleteSlashInFront) {
  EXPECT_EQ(numbered("/N8 G0 X5\n/ N9 G0 X6\n/G0\n / G1\n"), "/N1G0 X5\n/N2G0 X6\n/N3G0\n/N4G1\n");
}

TEST(LineNumberer, SaysOfABlockThatItKeepsSomething) {
  EXPECT_EQ(numbered("G28.1\nG 30 .1 (here)\n/g10l2p2x5\nG10 L1 P1 Z5\nG28\n(G28.1)\n"),
            "N1G28.1(kerf: stores)\nN2(kerf: stores)\nN2G 30 .1 (here)\n"
            "/N3g10l2p2x5(kerf: stores)\nN4G10 L1 P1 Z5\nN5G28\nN6(G28.1)\n");
}

TEST(LineNumberer, LeavesWhatPrintsNothing) {
  EXPECT_EQ(numbered("%\n\n  \t\n;N5 comment\n %\n(c)\n"), "%\n\n  \t\n;N5 comment\n %\nN6(c)\n");
}

TEST(LineNumberer, OWordsAndTheirLines) {
  EXPECT_EQ(numbered("o100 sub\nN5 o<a> call [1]\nO5\n"), "N1o100 sub\nN2o<a> call [1]\nN3O5\n");
}

TEST(LineNumberer, DropsCarriageReturns) {
  EXPECT_EQ(numbered("G0 X1\r\n\r\nM2\r\n"), "N1G0 X1\n\nN3M2\n");
}

TEST(LineNumberer, LastLineMayLackItsNewline) { EXPECT_EQ(numbered("G0\nM2"), "N1G0\nN2M2"); }

TEST(LineNumberer, LinesNearTheLimitKeepTheirText) {
  const auto line = [](std::size_t bytes) { return "G0(" + std::string(bytes - 4, 'a') + ")"; };
  for (const auto& [bytes, fits] : std::vector<std::pair<std::size_t, bool>>{
           {249, true}, {250, true}, {251, false}, {300, false}}) {
    LineNumberer numberer(0);
    std::string out;
    numberer.append(line(bytes) + "\n", out);
    EXPECT_EQ(out, (fits ? "N1" : "") + line(bytes) + "\n");
    EXPECT_EQ(numberer.unnumbered().size(), fits ? 0u : 1u);
  }
}

TEST(LineNumberer, NumbersThatWouldRunTogetherAreLeft) {
  EXPECT_EQ(numbered("10 G0\nN5 .5\nNX\n"), "10 G0\nN5 .5\nNX\n");
}

TEST(LineNumberer, CountsAcrossPiecesAndPowersOfTen) {
  LineNumberer numberer(0);
  std::string out;
  for (int i = 0; i < 1000; ++i) numberer.append("G0\n", out);
  EXPECT_EQ(numberer.lines(), 1000u);
  EXPECT_NE(out.find("\nN9G0\nN10G0\n"), out.npos);
  EXPECT_NE(out.find("\nN99G0\nN100G0\n"), out.npos);
  EXPECT_EQ(out.substr(out.size() - 8), "N1000G0\n");
}

TEST(LineNumberer, FilesHaveTheirOwnRange) {
  EXPECT_EQ(numbered("G0\nG1\n", 3), "N300000001G0\nN300000002G1\n");
  EXPECT_EQ(source_of_n(300000002), (SourceRef{3, 2}));
  EXPECT_EQ(source_of_n(118), (SourceRef{0, 118}));
  EXPECT_EQ(source_of_n(999'999'999'999'999'999), (SourceRef{0, 0}));
}

TEST(LineNumberer, FindsCalledSubroutines) {
  LineNumberer numberer(0);
  std::string out;
  numberer.append(
      "o<Here> sub\no<Here> endsub\nO<Here> CALL\nN7 o<Not Here> call\no12 call [1]\n"
      "/M98 P0044 L2\no[5] call\no7 if [1]\n(o<comment> call)\n",
      out);
  EXPECT_EQ(numberer.missing_subroutines(), (std::set<std::string>{"12", "44", "nothere"}));
}

TEST(LineNumberer, FindsNamedTools) {
  LineNumberer numberer(0);
  std::string out;
  numberer.append("T1 M6\nG43H02\nN5t 12m6\nM61 Q33\n(DEPTH 77, START99)\nG1 X4\n", out);
  EXPECT_EQ(numberer.tools().numbers, (std::set<int>{1, 2, 12, 33}));
  EXPECT_FALSE(numberer.tools().computed);
  numberer.append("T#1 M6\n", out);
  EXPECT_TRUE(numberer.tools().computed);
}

TEST(PrepareProgram, CopiesCalledFilesToo) {
  TestFolder folder;
  const std::string main = folder.write("main.nc", "o<one> call\no<none> call\nM2\n");
  folder.write("one.ngc", "o<one> sub\no<two> call\no<one> endsub\n");
  folder.write("two.ngc", "o<two> sub\no<one> call\nG0 X1\no<two> endsub\n");
  folder.write("copy/.keep", "");
  const auto prepared = prepare_program(main, folder.path("copy"));
  ASSERT_TRUE(prepared);
  EXPECT_EQ(prepared->main_name, "main.nc");
  EXPECT_EQ(prepared->lines, 3u);
  EXPECT_EQ(prepared->files,
            (std::vector<std::string>{main, folder.path("one.ngc"), folder.path("two.ngc")}));
  EXPECT_EQ(text_of(folder.path("copy/one.ngc")),
            "N100000001o<one> sub\nN100000002o<two> call\nN100000003o<one> endsub\n");
  EXPECT_NE(text_of(folder.path("copy/two.ngc")).find("N200000003G0 X1\n"), std::string::npos);
}

TEST(PrepareProgram, SaysWhatItCouldNotReadOrWrite) {
  TestFolder folder;
  const auto missing = prepare_program(folder.path("none.ngc"), folder.path("tmp"));
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error(),
            "cannot read " + folder.path("none.ngc") + ": No such file or directory");
  const auto nowhere = prepare_program(folder.write("a.ngc", "M2\n"), folder.path("nowhere"));
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error(),
            "writing " + folder.path("nowhere/a.ngc") + ": No such file or directory");
}

}  // namespace
}  // namespace kerf
