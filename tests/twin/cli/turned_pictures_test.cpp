// Parts that turn, by kerf: whole, cut open, with the tool, in the lathe; against pictures that
// were looked at and found good. After a wanted change of the looks:
//     KERF_UPDATE_GOLDEN=1 ctest -R TurnedPictures
// then look at tests/golden/turned/*.png before they are committed.
#include <gtest/gtest.h>

#include "tests/twin/cli/kerf_process.h"
#include "tests/viewer/golden_picture.h"

namespace kerf {
namespace {

/// Side of the squares that one pixel is the mean of: drivers differ along edges.
constexpr int kShrink = 4;
/// Mean over the channels, of 255. A section that is not hatched, or a tool that is missing, makes
/// 4 and more in a part.
constexpr double kWholeDifference = 1;
constexpr double kPartDifference = 4;

constexpr const char* kShaft =
    "G21 G18 G7 G90 G95\n"
    "T1 M6\n"
    "G97 S1000 M3\n"
    "G0 X42 Z2\n"
    "G0 X30\n"
    "G1 Z-30 F0.2\n"
    "G1 X36 Z-33\n"
    "G0 X50\n"
    "G0 Z2\n"
    "G0 X20\n"
    "G1 Z-15 F0.2\n"
    "G2 X30 Z-20 I5 K0\n"
    "G0 X50 Z5\n"
    "T2 M6\n"
    "M3 S1000\n"
    "G0 X0 Z5\n"
    "G1 Z-25 F0.1\n"
    "G0 Z5\n"
    "M2\n";

/// What makes the picture of the shaft, besides `more`.
void expect_shaft_looks_as_it_did(const std::string& name, const std::string& command,
                                  const std::vector<std::string>& more) {
  const TestFolder folder;
  KerfCall call;
  call.arguments = {command,    folder.write("shaft.ngc", kShaft),
                    "--stock",  "cylinder:0,0,-60:0:40",
                    "--tool",   "1=turn:0.8:2:93:33:holder=16x60",
                    "--tool",   "2=drill:8:118",
                    "--interp", "bridge",
                    "--png",    folder.file("picture.png")};
  call.arguments.insert(call.arguments.end(), more.begin(), more.end());
  const KerfResult result = run_kerf(call);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Picture found = test::shrunk(read_png_file(folder.file("picture.png")), kShrink);
  test::expect_golden(found, std::string(KERF_GOLDEN_FOLDER) + "/" + name + ".png",
                      kWholeDifference, kPartDifference);
}

TEST(TurnedPictures, TheWholeShaft) { expect_shaft_looks_as_it_did("shaft", "run", {}); }

TEST(TurnedPictures, HalfOfIt) {
  expect_shaft_looks_as_it_did("half", "run", {"--section", "half"});
}

TEST(TurnedPictures, ThreeQuarters) {
  expect_shaft_looks_as_it_did("quarter", "run", {"--section", "quarter"});
}

/// The insert lies flush in the section, its edge on the contour.
TEST(TurnedPictures, TheInsertInTheSection) {
  expect_shaft_looks_as_it_did("insert", "view",
                               {"--section", "half", "--view", "front", "--at-line", "8"});
}

/// The drill stands on the axis, with the turret behind it.
TEST(TurnedPictures, TheLatheAroundIt) {
  expect_shaft_looks_as_it_did("lathe", "view",
                               {"--set", "machine.model=lathe", "--at-line", "18"});
}

/// Neither rays nor CSG: the mesh, with a note.
TEST(TurnedPictures, OtherDrawModesAreTheMesh) {
  const TestFolder folder;
  for (const std::string mode : {"mesh", "raycast", "csg"}) {
    KerfCall call;
    call.arguments = {"view",    folder.write("shaft.ngc", kShaft),
                      "--stock", "cylinder:0,0,-60:0:40",
                      "--tool",  "1=turn:0.8:2:93:33",
                      "--tool",  "2=drill:8:118",
                      "--draw",  mode,
                      "--size",  "320x200",
                      "--png",   folder.file(mode + ".png")};
    const KerfResult result = run_kerf(call);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const bool has_note =
        result.err.find("a workpiece that turns is drawn by mesh alone") != std::string::npos;
    EXPECT_EQ(has_note, mode != "mesh") << result.err;
    EXPECT_EQ(read_png_file(folder.file(mode + ".png")).rgb,
              read_png_file(folder.file("mesh.png")).rgb);
  }
}

}  // namespace
}  // namespace kerf
