// Sheets and the machines that cut them, by kerf: the example of a punched panel at its end, its
// press at work, a torch table; against pictures that were looked at and found good. After a wanted
// change of the looks:
//     KERF_UPDATE_GOLDEN=1 ctest -R SheetPictures
// then look at tests/golden/sheet/*.png before they are committed.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/twin/kerf_process.h"
#include "tests/viewer/png_reader.h"
#include "viewer/picture.h"

namespace kerf {
namespace {

/// Side of the squares that one pixel is the mean of: drivers differ along edges.
constexpr int kShrink = 4;
/// Mean over the channels, of 255. A station that is missing, or a panel that did not come free,
/// makes 2 and more in a part.
constexpr double kWholeDifference = 1;
constexpr int kPart_px = 40;
constexpr double kPartDifference = 4;

Picture shrink(const Picture& picture) {
  Picture small{picture.width_px / kShrink, picture.height_px / kShrink, {}};
  for (int y = 0; y < small.height_px; ++y) {
    for (int x = 0; x < 3 * small.width_px; ++x) {
      int sum = 0;
      for (int n = 0; n < kShrink * kShrink; ++n) {
        const int row = kShrink * y + n / kShrink, column = kShrink * (x / 3) + n % kShrink;
        sum += picture.rgb[static_cast<std::size_t>(3 * (row * picture.width_px + column) + x % 3)];
      }
      small.rgb.push_back(static_cast<std::uint8_t>(sum / (kShrink * kShrink)));
    }
  }
  return small;
}

double difference(const Picture& a, const Picture& b, int left, int top, int width, int height) {
  double sum = 0;
  for (int y = top; y < top + height; ++y) {
    for (int x = 3 * left; x < 3 * (left + width); ++x) {
      const std::size_t n = static_cast<std::size_t>(3 * y * a.width_px + x);
      sum += std::abs(a.rgb[n] - b.rgb[n]);
    }
  }
  return sum / (3.0 * width * height);
}

/// `arguments`: what makes the picture of this name, without the file.
void expect_looks_as_it_did(const std::string& name, std::vector<std::string> arguments) {
  const TestFolder folder;
  KerfCall call;
  call.arguments = std::move(arguments);
  call.arguments.emplace_back("--png");
  call.arguments.push_back(folder.file("picture.png"));
  const KerfResult result = run_kerf(call);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Picture found = shrink(read_png_file(folder.file("picture.png")));
  const std::string path = std::string(KERF_GOLDEN_FOLDER) + "/" + name + ".png";
  if (std::getenv("KERF_UPDATE_GOLDEN") != nullptr) {
    const Done done = write_png(path, found);
    ASSERT_TRUE(done) << done.error();
  }
  const Picture golden = read_png_file(path);
  ASSERT_EQ(golden.rgb.size(), found.rgb.size()) << path;
  EXPECT_LT(difference(golden, found, 0, 0, found.width_px, found.height_px), kWholeDifference);
  for (int y = 0; y + kPart_px <= found.height_px; y += kPart_px)
    for (int x = 0; x + kPart_px <= found.width_px; x += kPart_px)
      EXPECT_LT(difference(golden, found, x, y, kPart_px, kPart_px), kPartDifference)
          << name << " at " << x << ' ' << y;
}

/// The example, by kerf-interp: `command` and what else it is given.
std::vector<std::string> panel(const std::string& command, std::vector<std::string> more) {
  const std::string folder = std::string(KERF_CONFIGS) + "/punch/";
  std::vector<std::string> words{
      command,    folder + "panel.ngc",   "--stock",  "sheet:0,0:400,300:2",
      "--turret", folder + "turret.yaml", "--interp", "bridge"};
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
