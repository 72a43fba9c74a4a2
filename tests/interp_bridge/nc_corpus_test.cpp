// Real programs of the shared test data: the interpreter with numbered copies must give what rs274
// alone prints. Needs KERF_SHARED_DATA.
#include <gtest/gtest.h>

#include "interp_bridge/interpreter_process.h"
#include "interp_bridge/program_prepare.h"
#include "interp_bridge/tool_table.h"
#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

/// The program's listing by rs274 itself, read as a listing.
ProgramRun run_plain(const ProgramOptions& options, const TestFolder& folder) {
  LineNumberer names(0);
  std::string ignored;
  names.append(text_of(options.path), ignored);
  std::vector<ToolTableRow> rows;
  Diagnostics row_faults;
  if (!options.tool_table_path.empty()) {
    rows = *read_tool_table(options.tool_table_path, row_faults);
  }
  const std::string table =
      folder.write("plain.tbl", interpreter_tool_table(rows, names.tools()).text);
  const std::string home = folder.path("home");
  std::filesystem::create_directories(home);
  const std::string listing = folder.path("plain.canon");
  const std::string command = "cd '" + home + "' && HOME='" + home + "' rs274 -b -t '" + table +
                              "' -v /nonexistent/x.var -g '" + options.path + "' '" + listing +
                              "' >plain.out 2>&1 </dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0) << options.path;
  ProgramOptions plain;
  plain.path = listing;
  return run_program(plain);
}

bool same_motion(const Motion& a, const Motion& b) {
  return a.kind == b.kind && a.to_mm == b.to_mm && a.from_mm == b.from_mm &&
         a.to_abc_deg == b.to_abc_deg && a.arc.center_mm == b.arc.center_mm &&
         a.arc.sweep_rad == b.arc.sweep_rad && a.feed_mm_per_min == b.feed_mm_per_min &&
         a.spindle == b.spindle && a.spindle_rpm == b.spindle_rpm && a.duration_s == b.duration_s &&
         a.flood == b.flood && a.start_known == b.start_known;
}

TEST(NcCorpus, NumberedCopiesRunAsTheProgramsDo) {
  if (shared_data().empty()) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
  ASSERT_NE(find_executable("rs274"), "") << "install linuxcnc-uspace";
  const std::filesystem::path root = shared_data() / "nc";
  std::size_t complete = 0;
  for (const Row& row : index_rows(root / "index.tsv")) {
    TestFolder folder;
    ProgramOptions options;
    options.path = (root / row.at("path")).string();
    options.interpreter = InterpreterChoice::kText;
    const auto table =
        root / "tables" / (std::filesystem::path(options.path).filename().string() + ".tbl");
    if (std::filesystem::exists(table)) options.tool_table_path = table.string();
    const ProgramRun run = run_program(options);
    ASSERT_TRUE(run.opened) << run.messages();
    EXPECT_TRUE(folder.nothing_left_behind());
    EXPECT_EQ(run.summary.program_lines, std::stoul(row.at("lines"))) << options.path;
    const std::string status = row.at("rs274_status");
    if (status != "ok") {
      // Stopped by an error, or with no end: said, with its place.
      if (status != "eof") continue;
      EXPECT_FALSE(has_error(run.diagnostics)) << run.messages();
      EXPECT_FALSE(run.summary.has_program_end);
      continue;
    }
    ++complete;
    EXPECT_FALSE(has_error(run.diagnostics)) << run.messages();
    EXPECT_TRUE(run.summary.has_program_end) << options.path;
    const ProgramRun plain = run_plain(options, folder);
    ASSERT_EQ(run.motions.size(), plain.motions.size()) << options.path;
    for (std::size_t i = 0; i < run.motions.size(); ++i) {
      ASSERT_TRUE(same_motion(run.motions[i], plain.motions[i])) << options.path << " " << i;
      ASSERT_LE(run.motions[i].source.line, run.summary.program_lines);
    }
    EXPECT_EQ(run.summary.canonical_commands, plain.summary.canonical_commands) << options.path;
  }
  EXPECT_GE(complete, 70u);
}

TEST(NcCorpus, RejectedProgramsSayWhere) {
  if (shared_data().empty()) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
  const std::filesystem::path root = shared_data() / "nc";
  std::size_t rejected = 0;
  for (const Row& row : index_rows(root / "index.tsv")) {
    const std::string& error = row.at("error");
    const std::string message = error.substr(0, error.find(" / "));
    // Messages that a tool table of other diameters would change are left to the programs that run.
    if (message.empty() || message.find("compensation") != message.npos ||
        message.find("File ended") != message.npos) {
      continue;
    }
    TestFolder folder;
    const ProgramRun run = run_program((root / row.at("path")).string());
    ASSERT_FALSE(run.diagnostics.empty()) << row.at("path");
    const Diagnostic& said = run.diagnostics.back();
    EXPECT_EQ(said.severity, Severity::kError);
    // The index cuts long messages, and quotes lines as they are in the file.
    EXPECT_EQ(said.message.substr(0, 30), message.substr(0, 30)) << row.at("path");
    EXPECT_GT(said.line, 0);
    EXPECT_FALSE(said.excerpt.empty());
    ++rejected;
  }
  EXPECT_GE(rejected, 25u);
}

}  // namespace
}  // namespace kerf
