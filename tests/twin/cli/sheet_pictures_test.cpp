// Sheets and the machines that cut them, by kerf: the example of a punched panel at its end, its
// press at work, a torch table; against pictures that were looked at and found good. After a wanted
// change of the looks:
//     KERF_UPDATE_GOLDEN=1 ctest -R SheetPictures
// then look at tests/golden/sheet/*.png before they are committed.
#include <gtest/gtest.h>

#include "tests/twin/cli/kerf_process.h"
#include "tests/viewer/golden_picture.h"

namespace kerf {
namespace {

/// Side of the squares that one pixel is the mean of: drivers differ along edges.
constexpr int kShrink = 4;
/// Mean over the channels, of 255. A station that is missing, or a panel that did not come free,
/// makes 2 and more in a part.
constexpr double kWholeDifference = 1;
constexpr double kPartDifference = 4;

/// `arguments`: what makes the picture of this name, without the file.
void expect_looks_as_it_did(const std::string& name, std::vector<std::string> arguments) {
  const TestFolder folder;
  KerfCall call;
  call.arguments = std::move(arguments);
  call.arguments.emplace_back("--png");
  call.arguments.push_back(folder.file("picture.png"));
  const KerfResult result = run_kerf(call);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Picture found = test::shrunk(read_png_file(folder.file("picture.png")), kShrink);
  test::expect_golden(found, std::string(KERF_GOLDEN_FOLDER) + "/" + name + ".png",
                      kWholeDifference, kPartDifference);
}

/// The example, by kerf-interp: `command` and what else it is given.
std::vector<std::string> panel(const std::string& command, std::vector<std::string> more) {
  std::vector<std::string> words{
      command,    KERF_EXAMPLES "/punch/panel.ngc",  "--stock",  "sheet:0,0:400,300:2",
      "--turret", KERF_CONFIGS "/punch/turret.yaml", "--interp", "bridge"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(SheetPictures, PanelAtTheEnd) { expect_looks_as_it_did("panel", panel("run", {})); }

/// At the end of the round window: the ram is down, station 5 is at work, the sheet has moved.
TEST(SheetPictures, PressInAStroke) {
  expect_looks_as_it_did("press", panel("view", {"--at-line", "37", "--size", "1280x720"}));
}

/// The torch where the program stands, the bridge with it; table and sheet have not moved.
TEST(SheetPictures, TorchTableInACut) {
  const TestFolder folder;
  const std::string program = folder.write(
      "cut.canon",
      "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
      "    2 N1     STRAIGHT_TRAVERSE(50.0000, 50.0000, 1.5000, 0.0000, 0.0000, 0.0000)\n"
      "    3 N2     SET_SPINDLE_SPEED(0, 1.0000)\n"
      "    4 N2     START_SPINDLE_CLOCKWISE(0)\n"
      "    5 N3     SET_FEED_RATE(3000.0000)\n"
      "    6 N3     STRAIGHT_FEED(300.0000, 50.0000, 1.5000, 0.0000, 0.0000, 0.0000)\n"
      "    7 N4     STRAIGHT_FEED(300.0000, 200.0000, 1.5000, 0.0000, 0.0000, 0.0000)\n"
      "    8 N5     STRAIGHT_FEED(50.0000, 200.0000, 1.5000, 0.0000, 0.0000, 0.0000)\n"
      "    9 N6     STOP_SPINDLE_TURNING(0)\n"
      "   10 N7     PROGRAM_END()\n");
  expect_looks_as_it_did("torch_table",
                         {"view", program, "--stock", "sheet:0,0:400,300:3", "--kerf", "3", "--set",
                          "machine.model=plasma", "--at-line", "5", "--size", "1280x720"});
}

}  // namespace
}  // namespace kerf
