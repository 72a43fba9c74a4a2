// Recorded runs of a real LinuxCNC, replayed along their program: the workpiece is that of the dry
// run, whatever the log. Skipped without $KERF_SHARED_DATA.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

class ReplayCorpus : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* shared = std::getenv("KERF_SHARED_DATA");
    if (shared == nullptr) GTEST_SKIP() << "KERF_SHARED_DATA is not set";
    logs_ = std::string(shared) + "/live_logs";
    for (const char* name :
         {"twin.ini", "twin.tbl", "twin.var", "pocket_drill.ngc", "sampler.hal"}) {
      folder_.write(name, read_file(logs_ + "/" + name));
    }
    // The positions of drives: the joints less the offsets of homing.
    folder_.write("drives.yaml",
                  "source:\n  type: can\n  interface: can0\n  map:\n"
                  "    X: {preset: cia402, node: 1, scale: 0.001, offset: 5}\n"
                  "    Y: {preset: cia402, node: 2, scale: 0.001, offset: -3}\n"
                  "    Z: {preset: cia402, node: 3, scale: 0.001, offset: 25.4}\n");
    folder_.write("turns.yaml",
                  "source:\n  type: can\n  interface: can0\n  map:\n"
                  "    X: {preset: odrive, node: 0, scale: 5, offset: 5}\n"
                  "    Y: {preset: odrive, node: 1, scale: 5, offset: -3}\n"
                  "    Z: {preset: odrive, node: 2, scale: 5, offset: 25.4}\n");
  }
  std::string unpacked(const std::string& name) const {
    const std::string path = folder_.file(name);
    const std::string command = "xz -dc " + logs_ + "/" + name + ".xz > " + path;
    EXPECT_EQ(std::system(command.c_str()), 0);
    return path;
  }
  Json report(std::vector<std::string> arguments) const {
    KerfCall call;
    call.folder = folder_.path();
    call.arguments = std::move(arguments);
    call.arguments.insert(call.arguments.end(),
                          {"--ini", "twin.ini", "--stock", "box:-30,-30,-20:60,50,0", "--cell",
                           "0.1", "--json", "report.json", "--quiet"});
    const KerfResult result = run_kerf(call);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return Json::parse(read_file(folder_.file("report.json")), nullptr, false);
  }
  TestFolder folder_;
  std::string logs_;
};

TEST_F(ReplayCorpus, EveryLogGivesTheWorkpieceOfTheDryRun) {
  const Json dry = report({"run", "pocket_drill.ngc", "--path", "planned"});
  const double wanted = dry["stock"]["removed_mm3"];
  const std::vector<std::vector<std::string>> logs = {
      {unpacked("pocket_drill.hal1k"), "--pins", "sampler.hal"},
      {logs_ + "/pocket_drill.100hz.csv"},
      {unpacked("pocket_drill.cia402.candump.log"), "-c", "drives.yaml"},
      {unpacked("pocket_drill.odrive.candump.log"), "-c", "turns.yaml"}};
  for (const std::vector<std::string>& log : logs) {
    std::vector<std::string> arguments = {"replay", "--program", "pocket_drill.ngc", "--speed",
                                          "max"};
    arguments.insert(arguments.end(), log.begin(), log.end());
    const Json live = report(arguments);
    EXPECT_NEAR(live["stock"]["removed_mm3"], wanted, 0.001 * wanted) << log[0];
    EXPECT_EQ(live["live"]["off_path"], 0) << log[0];
    EXPECT_EQ(live["live"]["gaps"], 0) << log[0];
    EXPECT_LT(live["live"]["following_mean_mm"], 0.005) << log[0];
    EXPECT_GT(live["live"]["path_mm"], 1600) << log[0];
  }
}

TEST_F(ReplayCorpus, WithoutTheProgramPositionsAloneNearlyDo) {
  const Json dry = report({"run", "pocket_drill.ngc", "--path", "planned"});
  const double wanted = dry["stock"]["removed_mm3"];
  const Json live =
      report({"replay", unpacked("pocket_drill.hal1k"), "--pins", "sampler.hal", "--speed", "max"});
  EXPECT_NEAR(live["stock"]["removed_mm3"], wanted, 0.002 * wanted);
}

}  // namespace
}  // namespace kerf
