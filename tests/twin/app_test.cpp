// The parts of the command line that need no process.
#include <gtest/gtest.h>

#include "twin/app/progress_bar.h"
#include "twin/app/run_options.h"
#include "twin/suggest.h"

namespace kerf {
namespace {

TEST(NearestWord, FindsTypingErrorsOnly) {
  const std::vector<std::string> words = {"--stock", "--tool", "--tool-table", "--stl", "run"};
  EXPECT_EQ(nearest_word("--stcok", words), "--stock");
  EXPECT_EQ(nearest_word("--tools", words), "--tool");
  EXPECT_EQ(nearest_word("rnu", words), "run");
  EXPECT_EQ(nearest_word("--fixture", words), "");
}

TEST(ProgressLine, ShowsShareAndSeconds) {
  EXPECT_EQ(progress_line(0.5, 12.3), "[###############...............]  50 %  12 s");
  EXPECT_EQ(progress_line(-1, 3), "running  3 s");
}

std::string faults_of(const RunArguments& arguments) {
  Diagnostics diagnostics;
  understand(arguments, diagnostics);
  std::string out;
  for (const Diagnostic& d : diagnostics) out += to_string(d);
  return out;
}

TEST(RunOptions, DefaultsAreGood) {
  Diagnostics diagnostics;
  RunArguments arguments;
  arguments.source.program = "part.ngc";
  const RunRequest request = understand(arguments, diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_GE(request.session.stock.threads, 1);
  EXPECT_EQ(request.session.stock.cell_mm, 0);
  EXPECT_EQ(request.mesh_tolerance_mm, 0.01);
  EXPECT_TRUE(request.session.program.block_delete);
}

TEST(RunOptions, AllFaultsComeAtOnce) {
  RunArguments a;
  a.work.cell = std::string("0");
  a.work.threads = std::string("1.5");
  a.work.kernel = std::string("gpu");
  a.work.model = std::string("voxels");
  a.source.interp = std::string("rs274");
  a.source.block_delete = std::string("maybe");
  a.mesh_tolerance = std::string("fine");
  a.work.margin = std::string("-1");
  EXPECT_EQ(faults_of(a),
            "kerf: error: --interp: 'rs274' is no interpreter; allowed: bridge, text\n"
            "kerf: error: --block-delete: 'maybe' is not allowed; on or off\n"
            "kerf: error: --model: 'voxels' is no model; allowed: zmap, mmap, octree, sheet, auto\n"
            "kerf: error: --kernel: 'gpu' is no kernel; allowed: auto, scalar, avx2\n"
            "kerf: error: --cell: 0 is not allowed; must be above 0 and at most 1000 (mm)\n"
            "kerf: error: --margin: -1 is not allowed; must be at least 0 and at most 10000 (mm)\n"
            "kerf: error: --threads: 1.5 is not a whole number\n"
            "kerf: error: --mesh-tolerance: 'fine' is not a number; must be at least 0 and at most "
            "1000 (mm)\n");
}

TEST(RunOptions, ToolsGivenTwiceOrBeyondTheModelAreRefused) {
  RunArguments a;
  a.work.model = "zmap";
  a.work.tools = {"1=flat:6", "1=ball:6", "2=lollipop:6:3"};
  EXPECT_EQ(faults_of(a),
            "kerf: error: --tool: '1=ball:6': tool 1 is given twice\n"
            "kerf: error: --tool: '2=lollipop:6:3': lollipop:6:3 cuts below itself (its neck is "
            "thinner than its head); a Z-map cannot hold undercuts\n");
}

TEST(RunOptions, TwoOutputsToOnePlaceAreRefused) {
  RunArguments a;
  a.outputs.json = std::string("-");
  a.outputs.stl = std::string("-");
  a.outputs.ply = std::string("part");
  a.outputs.state = std::string("part");
  EXPECT_EQ(faults_of(a),
            "kerf: error: --json and --stl both write to standard output\n"
            "kerf: error: --ply and --state both write to part\n");
}

TEST(OutputPlaces, AreCheckedBeforeTheRun) {
  OutputPaths paths;
  paths.stl = "/nonexistent/part.stl";
  paths.png = "/tmp";
  Diagnostics diagnostics;
  check_output_places(paths, diagnostics);
  ASSERT_EQ(diagnostics.size(), 2U);
  EXPECT_EQ(diagnostics[0].message, "--png: /tmp is a folder, not a file");
  EXPECT_EQ(
      diagnostics[1].message,
      "--stl: cannot write /nonexistent/part.stl: folder /nonexistent: No such file or directory");
}

}  // namespace
}  // namespace kerf
