// The machines that kerf draws by itself, around a part, as they are first seen; against pictures
// that were looked at and found good. After a wanted change of the looks:
//     KERF_UPDATE_GOLDEN=1 ctest -R MachinePictures
// then look at tests/golden/machine/*.png before they are committed.
#include <gtest/gtest.h>

#include "tests/twin/cli/kerf_process.h"
#include "tests/viewer/golden_picture.h"

namespace kerf {
namespace {

/// Side of the squares that one pixel is the mean of: drivers differ along edges.
constexpr int kShrink = 4;
/// Mean over the channels, of 255. A head that is opaque makes 20 and more in a part.
constexpr double kWholeDifference = 1;
constexpr double kPartDifference = 4;

constexpr const char* kSlot =
    "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
    "    2 N1     STRAIGHT_TRAVERSE(0.0000, 0.0000, 2.0000, 0.0000, 0.0000, 0.0000)\n"
    "    3 N2     SET_SPINDLE_SPEED(0, 1000.0000)\n"
    "    4 N2     START_SPINDLE_CLOCKWISE(0)\n"
    "    5 N3     SET_FEED_RATE(3000.0000)\n"
    "    6 N3     STRAIGHT_FEED(0.0000, 0.0000, -4.0000, 0.0000, 0.0000, 0.0000)\n"
    "    7 N4     STRAIGHT_FEED(20.0000, 5.0000, -4.0000, 0.0000, 0.0000, 0.0000)\n"
    "    8 N5     PROGRAM_END()\n";

class MachinePictures : public testing::Test {
 protected:
  Picture picture(const std::string& model, const std::string& stock, const std::string& view) {
    KerfCall call;
    call.arguments = {"view",    program_,
                      "--set",   "machine.model=" + model,
                      "--tool",  "1=flat:8:flute=20",
                      "--stock", stock,
                      "--view",  view,
                      "--size",  "1280x720",
                      "--png",   folder_.file("picture.png")};
    const KerfResult result = run_kerf(call);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return test::shrunk(read_png_file(folder_.file("picture.png")), kShrink);
  }
  void expect_looks_as_it_did(const std::string& name, const Picture& found) {
    test::expect_golden(found, std::string(KERF_GOLDEN_FOLDER) + "/" + name + ".png",
                        kWholeDifference, kPartDifference);
  }
  TestFolder folder_;
  std::string program_ = folder_.write("slot.canon", kSlot);
};

constexpr const char* kBar = "box:-10,-9,-44:23,9,0";

/// The eye begins inside the turret's slide.
TEST_F(MachinePictures, LatheWithTheEyeInItsSlide) {
  expect_looks_as_it_did("lathe", picture("lathe", kBar, "iso"));
}

TEST_F(MachinePictures, MillFromAbove) {
  expect_looks_as_it_did("mill_top", picture("knee-mill", "box:-40,-30,-20:60,40,0", "top"));
}

TEST_F(MachinePictures, MillFromBelow) {
  expect_looks_as_it_did("mill_bottom", picture("knee-mill", "box:-40,-30,-20:60,40,0", "bottom"));
}

/// What is in none of the eye's ways stays as it was.
TEST_F(MachinePictures, MillAsItIsFirstSeen) {
  expect_looks_as_it_did("mill", picture("knee-mill", "box:-40,-30,-20:60,40,0", "iso"));
}

}  // namespace
}  // namespace kerf
