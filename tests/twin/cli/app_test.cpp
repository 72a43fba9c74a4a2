// The parts of the command line that need no process.
#include <gtest/gtest.h>

#include <fstream>

#include "stock/sheet/sheet.h"
#include "tests/base/temporary_folder.h"
#include "twin/cli/live_options.h"
#include "twin/cli/progress_bar.h"
#include "twin/cli/run_options.h"
#include "viewer/window/settings.h"

namespace kerf {
namespace {

TEST(ProgressLine, ShowsShareAndSeconds) {
  EXPECT_EQ(progress_line(0.5, 12.3), "[###############...............]  50 %  12 s");
  EXPECT_EQ(progress_line(-1, 3), "running  3 s");
}

std::string faults_of(const Arguments& arguments) {
  Diagnostics diagnostics;
  understand_run(arguments, diagnostics);
  std::string out;
  for (const Diagnostic& d : diagnostics) out += to_string(d);
  return out;
}

TEST(RunOptions, DefaultsAreGood) {
  Diagnostics diagnostics;
  Arguments arguments;
  arguments.options.set("PROGRAM", "part.ngc");
  const RunRequest request = understand_run(arguments, diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_GE(request.session.stock.threads, 1);
  EXPECT_EQ(request.session.stock.cell_mm, 0);
  EXPECT_EQ(request.mesh_tolerance_mm, 0.01);
  EXPECT_TRUE(request.session.program.block_delete);
}

TEST(RunOptions, AllFaultsComeAtOnce) {
  Arguments a;
  a.options.set("--cell", "0");
  a.options.set("--threads", "1.5");
  a.options.set("--kernel", "gpu");
  a.options.set("--model", "voxels");
  a.options.set("--interp", "rs274");
  a.options.set("--block-delete", "maybe");
  a.options.set("--mesh-tolerance", "fine");
  a.options.set("--margin", "-1");
  EXPECT_EQ(faults_of(a),
            "kerf: error: --interp: 'rs274' is no interpreter; allowed: bridge, text\n"
            "kerf: error: --block-delete: 'maybe' is not allowed; must be on or off\n"
            "kerf: error: --model: 'voxels' is no model; allowed: auto, zmap, mmap, octree, sheet, "
            "turning\n"
            "kerf: error: --kernel: 'gpu' is no kernel; allowed: auto, scalar, sse2, avx2, neon\n"
            "kerf: error: --cell: 0 is not allowed; must be above 0 and at most 1000 (mm)\n"
            "kerf: error: --margin: -1 is not allowed; must be at least 0 and at most 10000 (mm)\n"
            "kerf: error: --threads: 1.5 is not a whole number\n"
            "kerf: error: --mesh-tolerance: 'fine' is not a number; must be at least 0 and at most "
            "1000 (mm)\n");
}

TEST(RunOptions, ToolsGivenTwiceOrBeyondTheModelAreRefused) {
  Arguments a;
  a.options.set("--model", "zmap");
  a.options.set_all("--tool", {"1=flat:6", "1=ball:6", "2=lollipop:6:3"});
  EXPECT_EQ(faults_of(a),
            "kerf: error: --tool: '1=ball:6': tool 1 is given twice\n"
            "kerf: error: --tool: '2=lollipop:6:3': lollipop:6:3 cuts below itself (its neck is "
            "thinner than its head); a Z-map cannot hold undercuts\n");
}

/// A blank that is given has no margin: what is written beside it would be ignored.
TEST(RunOptions, AMarginBesideABlankThatIsGivenIsRefused) {
  Arguments a;
  a.options.set("--margin", "2");
  EXPECT_EQ(faults_of(a), "");
  a.options.set("--stock", "box:0,0,0:9,9,9");
  EXPECT_EQ(faults_of(a),
            "kerf: error: --margin: is for a blank that is guessed from the program; this one is "
            "given\n"
            "   hint: without --stock it is guessed, and a wider --stock needs no margin\n");
}

TEST(RunOptions, TwoOutputsToOnePlaceAreRefused) {
  Arguments a;
  a.options.set("--json", "-");
  a.options.set("--stl", "-");
  a.options.set("--ply", "part");
  a.options.set("--state", "part");
  EXPECT_EQ(faults_of(a),
            "kerf: error: --json and --stl both write to standard output\n"
            "kerf: error: --ply and --state both write to part\n");
}

/// Of the command line in --units, of a configuration in mm.
TEST(RunOptions, LengthsAreOfTheUnitOfWhoeverSaysThem) {
  Arguments a;
  a.options.set("--units", "inch");
  a.options.set("--cell", "0.01");
  a.options.set_all("--set", {"stock.below_mm=2", "stock.cell_mm=1", "beam.trigger=z<25.4"});
  Diagnostics diagnostics;
  const RunRequest request = understand_run(a, diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_DOUBLE_EQ(request.session.stock.cell_mm, 0.254);
  EXPECT_EQ(request.session.below_mm, 2);
  EXPECT_EQ(request.session.margin_mm, 5);
  ASSERT_TRUE(request.session.beam.trigger);
  EXPECT_EQ(request.session.beam.trigger->terms()[0].level_mm, 25.4);
  a.options.set("--beam", "z<1");
  EXPECT_EQ(understand_run(a, diagnostics).session.beam.trigger->terms()[0].level_mm, 25.4);
}

TEST(RunOptions, ToolsAndBlankOfAConfigurationAreTakenWhereNoneAreWritten) {
  Arguments a;
  a.options.set_all("--set", {"tools.3=ball:4", "tools.4=flat:2", "stock.blank=box:0,0,0:1,2,3",
                              "stock.model=octree", "units=inch"});
  Diagnostics diagnostics;
  RunRequest request = understand_run(a, diagnostics);
  EXPECT_EQ(request.units, LengthUnit::kInch);
  EXPECT_EQ(request.session.tools.size(), 2u);
  EXPECT_FALSE(request.session.tools_named);
  ASSERT_TRUE(request.session.blank);
  EXPECT_EQ(request.session.blank->bounds_mm().max.z, 3);
  EXPECT_EQ(request.session.stock.kind, StockKind::kOctree);
  a.options.add("--tool", "1=flat:0.25");
  a.options.set("--stock", "box:0,0,0:1,1,1");
  a.options.set("--model", "auto");
  request = understand_run(a, diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  ASSERT_EQ(request.session.tools.size(), 1u);
  EXPECT_EQ(request.session.tools[0].tool, 1);
  EXPECT_TRUE(request.session.tools_named);
  EXPECT_DOUBLE_EQ(request.session.blank->bounds_mm().max.z, 25.4);
  EXPECT_EQ(request.session.stock.kind, std::nullopt);
}

/// What is known of the program is no reason to run off it: an INI's limits make a path planned.
/// As in a dry run: what a running program would set the machine's geometry by.
TEST(LiveOptions, PinsThatAreToldAreThoseOfTheKinematicsToo) {
  TemporaryFolder folder;
  const std::string ini = folder / "five.ini";
  std::ofstream(ini) << "[EMC]\nMACHINE = five\n[TRAJ]\nLINEAR_UNITS = mm\n"
                        "COORDINATES = X Y Z A C\n[KINS]\nKINEMATICS = xyzac-trt-kins\n"
                        "JOINTS = 5\n";
  Arguments a;
  a.command = kReplay;
  a.options.set("--ini", ini);
  const auto geometry = [&] {
    Diagnostics diagnostics;
    const LiveRequest request = understand_live(a, diagnostics);
    const auto& machine = request.options.cutting.timeline.kinematics;
    return machine && !machine->notes.empty() ? machine->notes.back() : std::string();
  };
  EXPECT_NE(geometry().find("y-offset 0"), std::string::npos) << geometry();
  a.options.set_all("--hal", {"xyzac-trt-kins.y-offset=12.5"});
  EXPECT_NE(geometry().find("as told: y-offset 12.5"), std::string::npos) << geometry();
}

TEST(LiveOptions, ThePathIsPlannedWhereLimitsAreKnownAndNobodySaysOtherwise) {
  TemporaryFolder folder;
  Arguments a;
  a.command = kShadow;
  Diagnostics diagnostics;
  const auto planned = [&] {
    return understand_live(a, diagnostics).options.cutting.timeline.planner.with_path;
  };
  EXPECT_FALSE(planned());
  const std::string ini = folder / "mill.ini";
  std::ofstream(ini) << "[TRAJ]\nLINEAR_UNITS = mm\nCOORDINATES = X Y Z\n"
                        "MAX_LINEAR_VELOCITY = 50\n"
                        "[KINS]\nKINEMATICS = trivkins\nJOINTS = 3\n"
                        "[AXIS_X]\nMAX_VELOCITY = 50\nMAX_ACCELERATION = 500\n"
                        "[AXIS_Y]\nMAX_VELOCITY = 50\nMAX_ACCELERATION = 500\n"
                        "[AXIS_Z]\nMAX_VELOCITY = 50\nMAX_ACCELERATION = 500\n";
  a.options.set("--ini", ini);
  EXPECT_TRUE(planned());
  a.options.add("--set", "follow.path=programmed");
  EXPECT_FALSE(planned());
  a.options.set("--path", "planned");
  EXPECT_TRUE(planned());
}

/// The rows that are for the same as constants elsewhere.
TEST(SettingTable, IsAsTheWindowHasIt) {
  EXPECT_EQ(setting_of("--tolerance", kView).least, kMinTolerance_mm);
  EXPECT_EQ(setting_of("--tolerance", kView).most, kMaxTolerance_mm);
  EXPECT_EQ(setting_of("--kerf", kRun).least, Sheet::kMinKerf_mm);
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
