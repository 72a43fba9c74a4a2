// A real headless LinuxCNC lathe runs programs; kerf watches it by HAL, and the workpieces that it
// ends with are those of the dry run: roughing at a feed per turn, threads, a constant surface
// speed. Skipped where LinuxCNC or namespaces of one's own are missing.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/live/classicladder/linuxcnc_session.h"
#include "tests/live/quiet_run.h"

namespace kerf {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// Followed along its program a lathe cuts what the dry run cuts.
constexpr double kFollowed = 0.002;
/// By positions alone, 5 ms apart.
constexpr double kByPositions = 0.005;

struct Case {
  const char* name;
  const char* program;  ///< below the folder of the test
  const char* work;     ///< blank and tools
};

/// All of them are sound: what is found is a false alarm.
constexpr Case kCases[] = {
    {"feed_per_turn", "programs/g95_rough.ngc",
     "--stock cylinder:0,0,-60:-1:48 --chuck 160:18 --tool 1=turn:0.4:2:85:30"},
    {"threads", "followed/threads.ngc",
     "--stock cylinder:0,0,-60:-4:20 --tool 1=turn:0.4:2:85:30 --tool 2=thread:60:edge=5"},
    {"surface_speed", "followed/g96.ngc",
     "--stock cylinder:0,0,-60:-1:48 --tool 1=turn:0.4:2:85:30"},
};

constexpr int kThreads = 1;  // of them

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A run of LinuxCNC, and what kerf makes of it.
struct FollowedRun {
  fs::path folder;
  int status = -1;
  std::string output;

  explicit FollowedRun(const Case& test_case) {
    std::string pattern = (fs::temp_directory_path() / "kerf-lathe.XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) return;
    folder = pattern;
    const std::string here = LATHE_FOLDER, work = test_case.work;
    const std::string program = here + "/" + test_case.program;
    std::string ini = text_of(here + "/lathe.ini");
    const std::string display = "measure_lathe.py";
    ini.replace(ini.find(display), display.size(), "drive.py");
    std::ofstream(folder / "driven.ini") << ini;
    // The machine stands for a moment at the end, so that the last position is seen.
    setenv("KERF_LIVE_READY", "sleep 1", 1);
    setenv("KERF_LIVE_AT_END", "sleep 1", 1);
    std::string command = RUN_LINUXCNC " --ini " + (folder / "driven.ini").string();
    for (const char* file : {"lathe.hal", "lathe.tbl", "lathe.var"}) {
      command += " --with " + here + "/" + file;
    }
    const fs::path run = folder / "run";
    status = shell(command + " --beside '" + here + "/watch_lathe " KERF_EXECUTABLE " " + program +
                       " " + work + "' " + program + " " + run.string() + " 2>&1",
                   output);
    const auto kerf = [&](const std::string& words, const std::string& name) {
      std::string said;
      const int code =
          shell("cd " + run.string() + " && " KERF_EXECUTABLE " " + words + " --ini mill3.ini " +
                    work + " --quiet --json " + name + ".json 2>&1",
                said);
      if (code != 0) output += words + ": " + said;
    };
    kerf("run " + program + " --path planned", "planned");
    kerf("replay live.csv --speed max --program " + program, "again");
    kerf("replay live.csv --speed max", "alone");
  }
  FollowedRun(const FollowedRun&) = delete;
  FollowedRun& operator=(const FollowedRun&) = delete;
  ~FollowedRun() {
    std::error_code ignored;
    if (!folder.empty()) fs::remove_all(folder, ignored);
  }
  Json report(const std::string& name) const {
    return Json::parse(text_of(folder / "run" / (name + ".json")), nullptr, false);
  }
  int gaps() const {
    const Json live = report("live");
    return live.is_object() ? live["live"].value("gaps", 0) : 0;
  }
  double removed_mm3(const std::string& name) const {
    const Json all = report(name);
    return all.is_object() ? all["stock"].value("removed_mm3", -1.0) : -1.0;
  }
  std::string said() const {
    std::string all = output;
    for (const char* name : {"linuxcnc.log", "live.err", "live.out"})
      all += text_of(folder / "run" / name);
    return all;
  }
};

/// One run for all tests of a case, made when the first of them asks.
template <int kCase>
struct RunOfCase : FollowedRun {
  RunOfCase() : FollowedRun(kCases[kCase]) {}
};

struct Seen {
  const FollowedRun* run = nullptr;
  bool stood_still = false;
};

template <int kCase>
Seen seen() {
  static const QuietRun<RunOfCase<kCase>> quiet;
  return {quiet.run.get(), quiet.stood_still()};
}

class ShadowOfLathe : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    std::string missing;
    if (shell(RUN_LINUXCNC " --check", missing) != 0) GTEST_SKIP() << missing;
    const Seen it = GetParam() == 0 ? seen<0>() : GetParam() == 1 ? seen<1>() : seen<2>();
    if (it.stood_still) GTEST_SKIP() << "this computer had no time for its processes";
    run_ = it.run;
    ASSERT_EQ(run_->status, 0) << run_->said();
    ASSERT_GT(run_->removed_mm3("planned"), 500) << run_->said();
  }
  const FollowedRun& run() const { return *run_; }

 private:
  const FollowedRun* run_ = nullptr;
};

TEST_P(ShadowOfLathe, TheWorkpieceIsThatOfTheDryRun) {
  const double planned_mm3 = run().removed_mm3("planned");
  const double live_mm3 = run().removed_mm3("live");
  EXPECT_NEAR(live_mm3, planned_mm3, kFollowed * planned_mm3) << run().said();
  RecordProperty("removed_mm3", std::to_string(live_mm3));
  RecordProperty("planned_mm3", std::to_string(planned_mm3));
}

TEST_P(ShadowOfLathe, ItsThreadsAreThoseOfTheDryRun) {
  const Json planned = run().report("planned")["turning"], live = run().report("live")["turning"];
  ASSERT_TRUE(planned.is_object() && live.is_object()) << run().said();
  const Json threads = planned.value("threads", Json::array());
  const Json followed = live.value("threads", Json::array());
  EXPECT_EQ(threads.size(), GetParam() == kThreads ? 2u : 0u);
  ASSERT_EQ(followed.size(), threads.size()) << live;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    for (const char* key : {"pitch_mm", "major_mm", "minor_mm", "pitch_diameter_mm"}) {
      EXPECT_NEAR(followed[i][key], threads[i][key], 0.02) << key << " " << followed[i];
    }
    EXPECT_EQ(followed[i].value("starts", 1), threads[i].value("starts", 1));
  }
}

TEST_P(ShadowOfLathe, TheRecordingGivesTheSameWorkpieceAgain) {
  EXPECT_EQ(run().report("again")["stock"]["digest"], run().report("live")["stock"]["digest"])
      << run().said();
}

/// But for threads: positions do not say where the spindle is, and what a threading tool sweeps is
/// taken all round.
TEST_P(ShadowOfLathe, ThePositionsAloneGiveNearlyTheSame) {
  const double planned_mm3 = run().removed_mm3("planned");
  if (GetParam() == kThreads) {
    EXPECT_GT(run().removed_mm3("alone"), planned_mm3);
    return;
  }
  EXPECT_NEAR(run().removed_mm3("alone"), planned_mm3, kByPositions * planned_mm3) << run().said();
}

TEST_P(ShadowOfLathe, ItWasFollowedOnThePath) {
  const Json live = run().report("live")["live"];
  ASSERT_TRUE(live.is_object()) << run().said();
  EXPECT_EQ(live["off_path"], 0) << run().said();
  EXPECT_EQ(live["gaps"], 0) << run().said();
  EXPECT_EQ(live["dropped"], 0);
  EXPECT_GT(live["on_path"], 1000);
  EXPECT_LT(live["following_mean_mm"], 0.02);
}

TEST_P(ShadowOfLathe, NothingIsFoundThatIsNotThere) {
  for (const char* name : {"planned", "live"}) {
    const Json report = run().report(name);
    ASSERT_TRUE(report.is_object()) << run().said();
    for (const Json& finding : report["findings"]) {
      EXPECT_EQ(finding["severity"], "note") << name << finding;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Programs, ShadowOfLathe, ::testing::Values(0, kThreads, 2),
                         [](const auto& which) { return std::string(kCases[which.param].name); });

}  // namespace
}  // namespace kerf
