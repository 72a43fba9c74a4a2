// Joints of a real LinuxCNC with maxkins (tests/live/kinematics/record_run), replayed: the part is
// that of the dry run of its program, along the program and without it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/twin/cli/kerf_process.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

/// Ways between two samples are chords: corners, where the machine stops, lose a little.
constexpr double kOfRemoved = 0.01;

Json report_of(std::vector<std::string> arguments) {
  const TestFolder folder;
  const std::string start = KERF_EXAMPLES "/five-axes/swivel_mill";
  KerfCall call;
  call.arguments = std::move(arguments);
  call.arguments.insert(call.arguments.end(),
                        {"--ini", start + ".ini", "--stock", "box:-20,-20,-20:20,20,0", "--tool",
                         "1=flat:16", "--tool", "2=drill:4:118", "--cell", "0.5", "--json",
                         folder.file("report.json"), "--quiet"});
  const KerfResult result = run_kerf(call);
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.err;
  Json report = Json::parse(read_file(folder.file("report.json")), nullptr, false);
  EXPECT_FALSE(report.is_discarded());
  return report;
}

TEST(SwivelReplay, TheRecordedMachineCutsWhatTheProgramSays) {
  const std::string start = KERF_EXAMPLES "/five-axes/swivel_mill";
  const Json dry = report_of({"run", start + ".ngc", "--interp", "bridge"});
  const double wanted = dry["stock"]["removed_mm3"];
  ASSERT_GT(wanted, 1000);
  const Json followed = report_of({"replay", ROTARY_FOLDER "/swivel_mill.csv", "--speed", "max",
                                   "--program", start + ".ngc", "--interp", "bridge"});
  EXPECT_EQ(followed["stock"]["model"], "octree");
  EXPECT_NEAR(followed["stock"]["removed_mm3"], wanted, kOfRemoved * wanted);
  EXPECT_EQ(followed["live"]["off_path"], 0) << followed["live"];
  const Json alone =
      report_of({"replay", ROTARY_FOLDER "/swivel_mill.csv", "--speed", "max", "--set",
                 "machine.work_offset.x=5", "--set", "machine.work_offset.y=-3", "--set",
                 "machine.work_offset.z=-40", "--set", "machine.tool_length=none"});
  EXPECT_NEAR(alone["stock"]["removed_mm3"], wanted, kOfRemoved * wanted);
}

}  // namespace
}  // namespace kerf
