// Programs that tilt the tool or turn the part, cut by kerf: pictures of the parts against such
// that were looked at and found good. After a wanted change of the looks:
//     KERF_UPDATE_GOLDEN=1 ctest -R RotaryPictures
// then look at tests/golden/rotary/*.png before they are committed.
#include <gtest/gtest.h>

#include "tests/twin/cli/kerf_process.h"
#include "tests/viewer/golden_picture.h"

namespace kerf {
namespace {

/// Side of the squares that one pixel is the mean of: drivers differ along edges.
constexpr int kShrink = 5;

struct Job {
  std::string name, program, ini;
  std::vector<std::string> work;  ///< blank, tools, cell
};

/// Cuts, draws and compares.
void expect_looks_as_it_did(const Job& job) {
  constexpr double kWholeDifference = 1.5;
  // A slot that leans by ten degrees less makes 6 to 15 there.
  constexpr double kPartDifference = 3;
  const TestFolder folder;
  KerfCall call;
  call.arguments = {"run",      job.program, "--ini", job.ini,
                    "--interp", "bridge",    "--png", folder.file("part.png")};
  call.arguments.insert(call.arguments.end(), job.work.begin(), job.work.end());
  const KerfResult result = run_kerf(call);
  ASSERT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.err;
  EXPECT_NE(result.out.find("octree, cells of"), std::string::npos) << result.out;
  const Picture drawn = read_png_file(folder.file("part.png"));
  ASSERT_EQ(drawn.width_px, 1600);
  test::expect_golden(test::shrunk(drawn, kShrink),
                      std::string(KERF_GOLDEN_FOLDER) + "/" + job.name + ".png", kWholeDifference,
                      kPartDifference);
}

/// Where the program and the INI lie: among the examples, or in this folder.
std::string start_of(const std::string& name) {
  if (name == "wrapped_shaft") return KERF_EXAMPLES "/fourth-axis/" + name;
  if (name == "swivel_mill") return KERF_EXAMPLES "/five-axes/" + name;
  return ROTARY_FOLDER "/" + name;
}

Job own(const std::string& name, std::vector<std::string> work) {
  const std::string start = start_of(name);
  return {name, start + ".ngc", start + ".ini", std::move(work)};
}

/// One of LinuxCNC's, for its machine with a tilting rotary table.
Job linuxcncs(const std::string& name, std::vector<std::string> work) {
  const std::string folder =
      "/usr/share/doc/linuxcnc/examples/sample-configs/sim/axis/vismach/5axis/"
      "table-rotary-tilting/";
  return {name, folder + "demos/" + name + ".ngc", folder + "xyzac-trt.ini", std::move(work)};
}

bool is_installed(const Job& job) { return file_exists(job.program) && file_exists(job.ini); }

TEST(RotaryPictures, ShaftOnAFourthAxis) {
  expect_looks_as_it_did(
      own("wrapped_shaft", {"--stock", "cylinder:0,0,0:80:40:x", "--tool", "1=flat:6", "--tool",
                            "2=drill:4:118", "--cell", "1"}));
}

TEST(RotaryPictures, BlockUnderABridgeMillsHead) {
  expect_looks_as_it_did(
      own("bridge_mill", {"--stock", "box:-36,-36,-30:36,36,0", "--tool", "1=flat:16", "--tool",
                          "2=ball:5", "--tool", "3=flat:10", "--cell", "1"}));
}

TEST(RotaryPictures, BlockOnATableThatTurnsUnderASwivellingHead) {
  expect_looks_as_it_did(
      own("swivel_mill", {"--stock", "box:-20,-20,-20:20,20,0", "--tool", "1=flat:16", "--tool",
                          "2=drill:4:118", "--cell", "0.5"}));
}

/// The machines around them, the head tilted in a cut.
TEST(RotaryPictures, MachinesWhoseHeadsTilt) {
  const std::pair<const char*, std::vector<std::string>> views[] = {
      {"bridge_mill", {"--at-line", "21", "--stock", "box:-36,-36,-30:36,36,0"}},
      {"swivel_mill", {"--at-line", "29", "--stock", "box:-20,-20,-20:20,20,0"}}};
  for (const auto& [name, what] : views) {
    SCOPED_TRACE(name);
    const TestFolder folder;
    const std::string start = start_of(name);
    KerfCall call;
    call.arguments = {"view",     start + ".ngc",
                      "--ini",    start + ".ini",
                      "--interp", "bridge",
                      "--cell",   "1",
                      "--tool",   "1=flat:16:flute=20:shank=16:holder=40x40",
                      "--tool",   "2=ball:5:flute=20:shank=5:holder=40x40",
                      "--tool",   "3=flat:10",
                      "--size",   "1280x720",
                      "--png",    folder.file("view.png")};
    call.arguments.insert(call.arguments.end(), what.begin(), what.end());
    const KerfResult result = run_kerf(call);
    ASSERT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.err;
    test::expect_golden(test::shrunk(read_png_file(folder.file("view.png")), kShrink),
                        std::string(KERF_GOLDEN_FOLDER) + "/" + name + "_machine.png", 1.5, 4);
  }
}

TEST(RotaryPictures, SlotsOfARobot) {
  expect_looks_as_it_did(own(
      "robot", {"--stock", "box:-60,-60,-40:60,60,0", "--tool", "1=bull:14:3", "--cell", "1.5"}));
}

TEST(RotaryPictures, Impeller) {
  const Job job = linuxcncs("impeller-7bl-xyzac", {"--stock", "cylinder:0,0,-8:32:90", "--tool",
                                                   "1=ball:4", "--cell", "1.5"});
  if (!is_installed(job)) GTEST_SKIP() << "LinuxCNC's examples are not installed";
  expect_looks_as_it_did(job);
}

TEST(RotaryPictures, Boat) {
  const Job job = linuxcncs("boat-xyzac", {"--stock", "box:-60,-37,-19:57,33,0", "--cell", "1.5"});
  if (!is_installed(job)) GTEST_SKIP() << "LinuxCNC's examples are not installed";
  expect_looks_as_it_did(job);
}

}  // namespace
}  // namespace kerf
