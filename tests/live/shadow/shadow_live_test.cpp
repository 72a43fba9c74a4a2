// A real headless LinuxCNC runs a program; kerf watches it by HAL and over Modbus TCP at the same
// time, and the workpieces that it ends with are that of the dry run. Skipped where LinuxCNC, Xvfb
// or namespaces of one's own are missing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "stock/zmap/zmap.h"
#include "tests/live/classicladder/linuxcnc_session.h"
#include "tests/live/quiet_run.h"

namespace kerf {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// One run of LinuxCNC for all tests.
struct WatchedRun {
  fs::path folder;
  int status = -1;
  std::string output;

  WatchedRun() {
    std::string pattern = (fs::temp_directory_path() / "kerf-shadow.XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) return;
    folder = pattern;
    fs::create_directory(folder / "run");
    for (const char* name : {"kerf_positions.tcl", "kerf_positions.clp", "kerf_ladder"}) {
      fs::copy(fs::path(LINUXCNC_CONFIGS) / name, folder / "run");
    }
    // An X server wants its folder to be root's or its own.
    std::ofstream(folder / "session.tcl")
        << "exec sh -c {mkdir -p /tmp/.X11-unix && mount -t tmpfs -o mode=1777 tmpfs "
           "/tmp/.X11-unix}\n"
        << "source [file join [file dirname [info script]] kerf_positions.tcl]\n";
    const std::string program = std::string(SHADOW_FOLDER) + "/part.ngc";
    // The machine stands for a moment at the end, so that the last position is seen.
    setenv("KERF_LIVE_READY", "sleep 1", 1);
    setenv("KERF_LIVE_AT_END", "sleep 1", 1);
    status = shell(std::string(RUN_LINUXCNC) + " --beside '" + SHADOW_FOLDER + "/watch " +
                       KERF_EXECUTABLE + " " + program + " " + LINUXCNC_CONFIGS +
                       "/kerf.yaml' --hal " + (folder / "session.tcl").string() + " " + program +
                       " " + (folder / "run").string() + " 2>&1",
                   output);
    for (const char* path : {"planned", "programmed"}) {
      std::string said;
      const int code =
          shell("cd " + (folder / "run").string() + " && " + KERF_EXECUTABLE + " run " + program +
                    " --ini mill3.ini --stock box:-30,-20,-8:30,20,0 --cell 0.1 --tool 1=flat:6 "
                    "--tool 2=drill:5:118 --quiet --path " +
                    path + " --json " + path + ".json --state " + path + ".state 2>&1",
                said);
      if (code != 0) output += said;
    }
  }
  ~WatchedRun() {
    std::error_code ignored;
    if (!folder.empty()) fs::remove_all(folder, ignored);
  }
  Json report(const std::string& name) const {
    return Json::parse(text_of(folder / "run" / (name + ".json")), nullptr, false);
  }
  /// That either of the two has told of, and samples that it has lost.
  int gaps() const {
    int all = 0;
    for (const char* source : {"hal", "modbus"}) {
      const Json live = report(source);
      if (live.is_object()) all += live["live"].value("gaps", 0) + live["live"].value("lost", 0);
    }
    return all;
  }
  std::unique_ptr<ZMap> workpiece(const std::string& name) const {
    auto loaded = ZMap::load((folder / "run" / (name + ".state")).string());
    return loaded ? std::move(loaded.value()) : nullptr;
  }
};

const QuietRun<WatchedRun>& quiet() {
  static const QuietRun<WatchedRun> one;
  return one;
}
const WatchedRun& the_run() { return *quiet().run; }

/// Share of the cells whose heights differ by more than `by_mm`.
double share_of_differences(const ZMap& a, const ZMap& b, double by_mm) {
  std::size_t different = 0;
  for (int j = 0; j < a.ny(); ++j) {
    for (int i = 0; i < a.nx(); ++i) {
      different += std::abs(a.height_mm(i, j) - b.height_mm(i, j)) > by_mm ? 1 : 0;
    }
  }
  return static_cast<double>(different) / (static_cast<double>(a.nx()) * a.ny());
}

class ShadowOfLinuxCnc : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string missing = LinuxCncSession::missing();
    if (!missing.empty()) GTEST_SKIP() << missing;
    if (quiet().stood_still()) GTEST_SKIP() << "this computer had no time for its processes";
    ASSERT_EQ(the_run().status, 0)
        << the_run().output << text_of(the_run().folder / "run" / "linuxcnc.log") << said();
  }
  std::string said() const {
    const fs::path run = the_run().folder / "run";
    return text_of(run / (std::string(GetParam()) + ".err")) +
           text_of(run / (std::string(GetParam()) + ".out"));
  }
};

TEST_P(ShadowOfLinuxCnc, TheWorkpieceIsThatOfTheDryRun) {
  const WatchedRun& run = the_run();
  const Json live = run.report(GetParam());
  ASSERT_FALSE(live.is_discarded()) << said();
  const Json planned = run.report("planned");
  const Json programmed = run.report("programmed");
  ASSERT_FALSE(planned.is_discarded()) << run.output;
  const double removed = live["stock"]["removed_mm3"];
  const double by_plan = planned["stock"]["removed_mm3"];
  EXPECT_NEAR(removed, by_plan, 0.002 * by_plan);
  // The zigzag is run through with corners rounded by up to a millimetre.
  EXPECT_NEAR(removed, programmed["stock"]["removed_mm3"], 0.01 * by_plan);
  const auto seen = run.workpiece(GetParam());
  const auto dry = run.workpiece("planned");
  ASSERT_TRUE(seen && dry) << said();
  // Beside a wall a cell is at the top or at the bottom, as a micrometre will have it.
  EXPECT_LT(share_of_differences(*seen, *dry, 0.005), 0.002);
  RecordProperty("removed_mm3", std::to_string(removed));
}

/// What the positions say without any program: 200 a second by HAL, 100 by Modbus, up to 0.4 mm
/// apart.
TEST_P(ShadowOfLinuxCnc, TheRecordedPositionsAloneGiveTheSameWorkpiece) {
  const WatchedRun& run = the_run();
  std::string said;
  const std::string name = GetParam();
  const int code =
      shell("cd " + (run.folder / "run").string() + " && " + KERF_EXECUTABLE + " replay " + name +
                ".csv --ini mill3.ini --speed max --stock box:-30,-20,-8:30,20,0 "
                "--cell 0.1 --tool 1=flat:6 --tool 2=drill:5:118 --quiet --json "
                "again.json --state again.state 2>&1",
            said);
  // A recording that lacks samples says so.
  const Json live = run.report(name)["live"];
  const int missing = live.value("lost", 0) + live.value("gaps", 0);
  EXPECT_EQ(code, missing > 0 ? 3 : 0) << said << run.report("again")["live"];
  const double by_plan = run.report("planned")["stock"]["removed_mm3"];
  EXPECT_NEAR(run.report("again")["stock"]["removed_mm3"], by_plan, 0.005 * by_plan);
  const auto seen = run.workpiece("again");
  const auto dry = run.workpiece("planned");
  ASSERT_TRUE(seen && dry) << said;
  EXPECT_LT(share_of_differences(*seen, *dry, 0.05), 0.01);
}

TEST_P(ShadowOfLinuxCnc, ItWasFollowedOnThePath) {
  const Json live = the_run().report(GetParam())["live"];
  ASSERT_TRUE(live.is_object()) << said();
  EXPECT_EQ(live["off_path"], 0) << said();
  EXPECT_EQ(live["gaps"], 0) << said();
  EXPECT_EQ(live["dropped"], 0);
  EXPECT_GT(live["on_path"], 1000);
  EXPECT_LT(live["following_mean_mm"], 0.02);
  // All but the way to the first position of the program.
  EXPECT_LT(live["chord_mm"].get<double>(), 0.35 * live["path_mm"].get<double>());
}

TEST_P(ShadowOfLinuxCnc, NothingIsFoundThatIsNotThere) {
  const Json report = the_run().report(GetParam());
  ASSERT_TRUE(report.is_object()) << said();
  for (const Json& finding : report["findings"]) {
    EXPECT_EQ(finding["severity"], "note") << finding;
  }
}

INSTANTIATE_TEST_SUITE_P(Sources, ShadowOfLinuxCnc, ::testing::Values("hal", "modbus"),
                         [](const auto& source) { return std::string(source.param); });

}  // namespace
}  // namespace kerf
