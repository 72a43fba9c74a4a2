// Hints of real programs, if KERF_SHARED_DATA names a folder that holds them (nc/ with programs by
// kind).
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "stock/cutter/shape_spec.h"
#include "stock/cutter/tool_hints.h"
#include "tests/stock/program_comments.h"

namespace kerf {
namespace {

TEST(ToolHintCorpus, EveryDialectIsFound) {
  const char* const data = std::getenv("KERF_SHARED_DATA");
  if (data == nullptr) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
  std::map<std::string, int> programs_of;  // dialect -> programs with at least one such hint
  int programs = 0;
  int hinted = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(data) / "nc")) {
    const std::string extension = entry.path().extension().string();
    if (!entry.is_regular_file() || extension == ".tsv" || extension == ".tbl") continue;
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::vector<CommentText> comments = comments_of(text);
    std::map<std::string, int> hints_of;
    for (const ToolHint& hint : find_tool_hints(comments)) {
      EXPECT_TRUE(parse_shape(hint.shape)) << entry.path() << ": " << hint.shape;
      ++hints_of[hint.dialect];
    }
    ++programs;
    if (!hints_of.empty()) ++hinted;
    for (const auto& [dialect, count] : hints_of) ++programs_of[dialect];
    (void)find_blank_hint(comments);
  }
  std::printf("%d of %d programs carry a tool hint\n", hinted, programs);
  for (const auto& [dialect, count] : programs_of) {
    std::printf("  %-10s %3d programs\n", dialect.c_str(), count);
  }
  const std::map<std::string, int> minimum = {
      {"fusion", 7},  {"cambam", 3},   {"cutviewer", 2}, {"fabex", 2},     {"flatcam", 3},
      {"freecad", 4}, {"list", 8},     {"message", 1},   {"pcb2gcode", 1}, {"prose", 6},
      {"pycam", 1},   {"sheetcam", 1}, {"tool-line", 2}, {"turret", 1}};
  for (const auto& [dialect, count] : minimum) EXPECT_GE(programs_of[dialect], count) << dialect;
  EXPECT_GE(hinted, 38);
}

}  // namespace
}  // namespace kerf
