// A real headless LinuxCNC whose table tilts and turns runs a program that switches its kinematics;
// kerf watches it by HAL, and the workpiece that it ends with is that of the dry run. Skipped where
// LinuxCNC or namespaces of one's own are missing.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "stock/octree/octree.h"
#include "tests/live/classicladder/linuxcnc_session.h"
#include "tests/live/quiet_run.h"
#include "tests/twin/live/surface_deviation.h"

namespace kerf {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// Followed along its program a machine cuts what the dry run cuts, but for how curved ways are
/// divided: by 0.01 mm on either side (ToolPathTolerance::of_cell) of some 500 mm2 that are cut,
/// of 1300 mm3.
constexpr double kFollowed = 0.004;
/// By positions alone corners are as LinuxCNC rounds them.
constexpr double kByPositions = 0.01;
/// Corners of the mesh follow from the faces around them: where these hardly lean, by more than the
/// surface is off.
constexpr double kDeviation_mm = 0.1;

constexpr const char* kWork =
    "--ini mill3.ini --stock box:-15,-15,-20:15,15,0 --cell 0.5 --tool 1=ball:6:flute=20 --quiet ";

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// One run of LinuxCNC for all tests, and what kerf makes of it.
struct TurningRun {
  fs::path folder;
  int status = -1;
  std::string output;

  TurningRun() {
    std::string pattern = (fs::temp_directory_path() / "kerf-turning.XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) return;
    folder = pattern;
    const std::string here = TURNING_FOLDER;
    const std::string program = here + "/part.ngc";
    // The machine stands for a moment at the end, so that the last position is seen.
    setenv("KERF_LIVE_READY", "sleep 1", 1);
    setenv("KERF_LIVE_AT_END", "sleep 1", 1);
    std::string command = RUN_LINUXCNC " --ini " + here + "/xyzac.ini";
    for (const char* file : {"xyzac.hal", "428remap.ngc", "429remap.ngc"}) {
      command += " --with " + here + "/" + file;
    }
    status = shell(command + " --beside '" + here + "/watch " KERF_EXECUTABLE " " + program + "' " +
                       program + " " + folder.string() + " 2>&1",
                   output);
    kerf("run " + program + " --path planned", "planned");
    kerf("replay live.csv --speed max --program " + program, "again");
    kerf("replay live.csv --speed max --model octree", "alone");
  }
  ~TurningRun() {
    std::error_code ignored;
    if (!folder.empty()) fs::remove_all(folder, ignored);
  }
  /// Results of other commands in the folder of the INI.
  void kerf(const std::string& command, const std::string& name) {
    std::string said;
    const int code = shell("cd " + folder.string() + " && " KERF_EXECUTABLE " " + command + " " +
                               kWork + "--json " + name + ".json --state " + name + ".state 2>&1",
                           said);
    if (code != 0) output += command + ": " + said;
  }
  Json report(const std::string& name) const {
    return Json::parse(text_of(folder / (name + ".json")), nullptr, false);
  }
  int gaps() const {
    const Json live = report("live");
    return live.is_object() ? live["live"].value("gaps", 0) : 0;
  }
  double removed_mm3(const std::string& name) const {
    const Json all = report(name);
    return all.is_object() ? all["stock"].value("removed_mm3", -1.0) : -1.0;
  }
  std::unique_ptr<Octree> workpiece(const std::string& name) const {
    auto loaded = Octree::load((folder / (name + ".state")).string());
    return loaded ? std::move(loaded.value()) : nullptr;
  }
};

const QuietRun<TurningRun>& quiet() {
  static const QuietRun<TurningRun> one;
  return one;
}
const TurningRun& the_run() { return *quiet().run; }

class ShadowOfTurningLinuxCnc : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string missing;
    if (shell(RUN_LINUXCNC " --check", missing) != 0) GTEST_SKIP() << missing;
    if (quiet().stood_still()) GTEST_SKIP() << "this computer had no time for its processes";
    ASSERT_EQ(the_run().status, 0) << said();
    ASSERT_GT(the_run().removed_mm3("planned"), 500) << said();
  }
  static std::string said() {
    std::string all = the_run().output;
    for (const char* name : {"linuxcnc.log", "live.err", "live.out"}) {
      all += text_of(the_run().folder / name);
    }
    return all;
  }
};

TEST_F(ShadowOfTurningLinuxCnc, TheWorkpieceIsThatOfTheDryRun) {
  const double planned_mm3 = the_run().removed_mm3("planned");
  const double live_mm3 = the_run().removed_mm3("live");
  EXPECT_NEAR(live_mm3, planned_mm3, kFollowed * planned_mm3) << said();
  const auto seen = the_run().workpiece("live");
  const auto dry = the_run().workpiece("planned");
  ASSERT_TRUE(seen && dry) << said();
  EXPECT_LT(surface_deviation_mm(*seen, *dry), kDeviation_mm);
  RecordProperty("removed_mm3", std::to_string(live_mm3));
  RecordProperty("planned_mm3", std::to_string(planned_mm3));
}

TEST_F(ShadowOfTurningLinuxCnc, TheRecordingGivesTheSameWorkpieceAgain) {
  EXPECT_EQ(the_run().report("again")["stock"]["digest"],
            the_run().report("live")["stock"]["digest"])
      << said();
}

TEST_F(ShadowOfTurningLinuxCnc, ThePositionsAloneGiveNearlyTheSame) {
  const double planned_mm3 = the_run().removed_mm3("planned");
  EXPECT_NEAR(the_run().removed_mm3("alone"), planned_mm3, kByPositions * planned_mm3) << said();
}

TEST_F(ShadowOfTurningLinuxCnc, ItWasFollowedThroughTheSwitches) {
  const Json live = the_run().report("live")["live"];
  ASSERT_TRUE(live.is_object()) << said();
  EXPECT_EQ(live["off_path"], 0) << said();
  EXPECT_EQ(live["gaps"], 0) << said();
  EXPECT_EQ(live["dropped"], 0);
  EXPECT_GT(live["on_path"], 1000);
  EXPECT_LT(live["following_mean_mm"], 0.05);
}

TEST_F(ShadowOfTurningLinuxCnc, NothingIsFoundThatIsNotThere) {
  const Json live = the_run().report("live");
  ASSERT_TRUE(live.is_object()) << said();
  for (const Json& finding : live["findings"]) {
    EXPECT_EQ(finding["severity"], "note") << finding;
  }
}

}  // namespace
}  // namespace kerf
