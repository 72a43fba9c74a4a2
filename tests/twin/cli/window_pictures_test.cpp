// Windows as somebody sees them, whole, against pictures that were looked at and found good. (The
// tenth, beside a machine, is in tests/viewer/window_looks_test.cpp: there it stands still.)
// After a wanted change of the looks:
//     KERF_UPDATE_GOLDEN=1 ctest -R WindowPictures
// then look at tests/golden/window/*.png before they are committed; `convert FILE -colors 250 FILE`
// makes them small.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "tests/twin/cli/window_process.h"
#include "tests/viewer/golden_picture.h"
#include "tests/viewer/virtual_display.h"

namespace kerf {
namespace {

/// Side of the squares that one pixel is the mean of: drivers differ along edges, versions of Dear
/// ImGui in letters.
constexpr int kShrink = 4;
/// Mean over the channels, of 255; in all of the window and in each square of 80 of its pixels. The
/// palettes of the files make up to 2 in a part, a row of figures that is missing 3, a scene that
/// is shifted by 4 pixels 7.
constexpr double kWholeDifference = 1.0, kPartDifference = 3.0;
constexpr int kPart_px = 20;
constexpr std::chrono::seconds kPatience{60};

/// No machine, and no hint for beginners.
constexpr const char* kSettings =
    "width = 1000\nheight = 640\npanel.code.width = 200\npanel.info.width = 270\n"
    "keys-seen = on\nshow.machine = off\n";

/// A pocket of 40 x 20 in steps of 2.5 mm down to `depth_mm`, by a tool of 6 mm.
std::string pocket(double depth_mm, const std::string& end) {
  std::string text =
      "(a pocket of 40 x 20)\nG21 G90 G17 G94 G64 P0.01\nT1 M6 S8000 M3\nG0 X30 Y20 Z3\n";
  for (double z = -2.5; z > -depth_mm - 2.5; z -= 2.5) {
    text += fmt::format("G1 Z{:.3f} F300\n", std::max(z, -depth_mm));
    for (const double away : {2.0, 4.5, 7.0}) {
      text += fmt::format("G1 X{0} Y{2} F1800\nX{1}\nY{3}\nX{0}\nY{2}\n", 20 - away, 40 + away,
                          20 - away, 20 + away);
    }
    text += "X30 Y20\n";
  }
  return text + "G0 Z10\n" + end + "M5\nM2\n";
}
const std::vector<std::string> kPocketWork = {
    "--stock", "box:0,0,-12:60,40,0", "--tool", "1=flat:6", "--cell", "0.2"};

/// Two waves across each other, row by row.
std::string relief() {
  std::string text = "(a relief)\nG21 G90 G17 G94 G64 P0.01\nT1 M6 S12000 M3\nG0 X0 Y0 Z5\n";
  for (int row = 0; row <= 80; ++row) {
    const double y = 0.5 * row;
    for (int step = 0; step <= 60; ++step) {
      const double x = row % 2 == 0 ? step : 60 - step;
      const double z = -4 + 2 * std::sin(x / 8) * std::cos(y / 6) + std::sin(y / 3);
      text += fmt::format("{}X{:.3f} Y{:.3f} Z{:.3f}{}\n", row + step == 0 ? "G1 " : "", x, y, z,
                          row + step == 0 ? " F2400" : "");
    }
  }
  return text + "G0 Z10\nM5\nM2\n";
}

/// K E R F by strokes.
std::string engraving() {
  using Point = std::array<double, 2>;
  const std::vector<std::vector<Point>> letters[] = {
      {{{0, 0}, {0, 10}}, {{6, 10}, {0, 4.5}}, {{2.2, 6.5}, {6, 0}}},
      {{{6, 0}, {0, 0}, {0, 10}, {6, 10}}, {{0, 5}, {4.5, 5}}},
      {{{0, 0}, {0, 10}, {4, 10}, {6, 8.5}, {6, 6.5}, {4, 5}, {0, 5}}, {{3, 5}, {6, 0}}},
      {{{0, 0}, {0, 10}, {6, 10}}, {{0, 5}, {4.5, 5}}}};
  std::string text = "(a name)\nG21 G90 G17 G94 G64 P0.01\nT1 M6 S18000 M3\nG0 Z3\n";
  double left = 5;
  for (const auto& letter : letters) {
    for (const std::vector<Point>& stroke : letter) {
      text += fmt::format("G0 X{} Y{}\nG1 Z-0.8 F300\n", left + stroke[0][0], 5 + stroke[0][1]);
      for (const Point& at : stroke)
        text += fmt::format("G1 X{} Y{} F900\n", left + at[0], 5 + at[1]);
      text += "G0 Z3\n";
    }
    left += 9;
  }
  return text + "M5\nM2\n";
}

/// A block with a pocket of 40 x 20 x 5 with sharp corners, as STL.
std::string design() {
  using Corner = std::array<double, 3>;
  std::string text = "solid design\n";
  const auto quad = [&](const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
    for (const auto& [p, q, r] : {std::array{a, b, c}, std::array{a, c, d}}) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const Corner& at : {p, q, r}) {
        text += fmt::format("vertex {} {} {}\n", at[0], at[1], at[2]);
      }
      text += "endloop\nendfacet\n";
    }
  };
  // Counter-clockwise from above.
  const std::array<std::array<double, 2>, 4> outer{{{0, 0}, {60, 0}, {60, 40}, {0, 40}}};
  const std::array<std::array<double, 2>, 4> inner{{{10, 10}, {50, 10}, {50, 30}, {10, 30}}};
  const auto at = [](const std::array<double, 2>& xy, double z) { return Corner{xy[0], xy[1], z}; };
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t k = (i + 1) % 4;
    quad(at(outer[i], -12), at(outer[k], -12), at(outer[k], 0), at(outer[i], 0));
    quad(at(outer[i], 0), at(outer[k], 0), at(inner[k], 0), at(inner[i], 0));
    quad(at(inner[i], 0), at(inner[k], 0), at(inner[k], -5), at(inner[i], -5));
  }
  quad(at(inner[0], -5), at(inner[1], -5), at(inner[2], -5), at(inner[3], -5));
  quad(at(outer[0], -12), at(outer[3], -12), at(outer[2], -12), at(outer[1], -12));
  return text + "endsolid design\n";
}

class WindowPictures : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!display_trouble().empty()) GTEST_SKIP() << display_trouble();
    if (access("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", R_OK) != 0) {
      GTEST_SKIP() << "the font is not installed (Debian package fonts-dejavu-core)";
    }
  }

  void open(std::vector<std::string> arguments, const std::vector<std::string>& work,
            const std::string& settings = {}) {
    KerfCall call;
    call.arguments = std::move(arguments);
    call.arguments.insert(call.arguments.end(), work.begin(), work.end());
    kerf_ = std::make_unique<WindowedKerf>(std::move(call), kSettings + settings);
    // Where nothing is pointed at: on the background.
    ASSERT_TRUE(xdotool("mousemove 212 130"));
    ASSERT_TRUE(kerf_->opens());
  }

  /// Whole, without a word of pictures that were saved. One of the scene alone may come late.
  Picture window() {
    Picture picture;
    for (int tries = 0; tries < 10 && picture.width_px != 1000; ++tries) {
      kerf_->key("Escape");
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      picture = kerf_->screenshot("S");
    }
    return picture;
  }

  void press(std::initializer_list<const char*> keys) {
    for (const char* name : keys) {
      kerf_->key(name);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }

  static double worst_part(const Picture& a, const Picture& b) {
    double worst = 0;
    for (int y = 0; y + kPart_px <= a.height_px; y += kPart_px) {
      for (int x = 0; x + kPart_px <= a.width_px; x += kPart_px) {
        worst = std::max(worst, test::difference(a, b, x, y, kPart_px, kPart_px));
      }
    }
    return worst;
  }

  /// When what takes its time is there: the workpiece, the end of the program.
  void expect_looks_as_it_did(const std::string& name) {
    const std::string path = std::string(KERF_GOLDEN_FOLDER) + "/" + name + ".png";
    if (std::getenv("KERF_UPDATE_GOLDEN") != nullptr) {
      std::this_thread::sleep_for(std::chrono::seconds(8));
      const Done done = write_png(path, window());
      ASSERT_TRUE(done) << done.error();
    }
    const Picture golden = read_png_file(path);
    ASSERT_EQ(golden.width_px, 1000) << path;
    const Picture wanted = test::shrunk(golden, kShrink);
    double whole = 0, part = 0;
    Picture last;
    const auto end = std::chrono::steady_clock::now() + kPatience;
    do {
      last = window();
      ASSERT_EQ(last.rgb.size(), golden.rgb.size()) << path;
      const Picture found = test::shrunk(last, kShrink);
      whole = test::difference(wanted, found, 0, 0, found.width_px, found.height_px);
      part = worst_part(wanted, found);
      if (whole < kWholeDifference && part < kPartDifference) break;
    } while (std::chrono::steady_clock::now() < end);
    EXPECT_LT(whole, kWholeDifference) << path;
    EXPECT_LT(part, kPartDifference) << path;
    if (HasFailure()) {
      const std::string seen = testing::TempDir() + name + "_seen.png";
      if (write_png(seen, last)) ADD_FAILURE() << "seen: " << seen;
    }
    kerf_->key("Q");
    kerf_->finish();
  }

  TestFolder folder_;
  std::unique_ptr<WindowedKerf> kerf_;
};

TEST_F(WindowPictures, Pocket) {
  open({"view", folder_.write("pocket.ngc", pocket(5, "")), "--at-line", "14"}, kPocketWork);
  press({"7"});
  expect_looks_as_it_did("pocket");
}

TEST_F(WindowPictures, Relief) {
  open({"view", folder_.write("relief.ngc", relief())},
       {"--stock", "box:-2,-2,-12:62,42,0", "--tool", "1=ball:4", "--cell", "0.2"},
       "color = height\n");
  press({"7", "k", "End"});
  expect_looks_as_it_did("relief");
}

TEST_F(WindowPictures, Engraving) {
  open({"view", folder_.write("name.ngc", engraving()), "--at-line", "37"},
       {"--stock", "box:0,0,-3:42,20,0", "--tool", "1=vee:6:60", "--cell", "0.05"},
       "units = inch\n");
  press({"5"});
  expect_looks_as_it_did("engraving");
}

#ifdef KERF_HAS_INTERP
TEST_F(WindowPictures, FiveAxes) {
  const std::string start = KERF_EXAMPLES "/five-axes/swivel_mill";
  open({"view", start + ".ngc", "--ini", start + ".ini", "--interp", "bridge", "--at-line", "29"},
       {"--stock", "box:-20,-20,-20:20,20,0", "--tool", "1=flat:16", "--tool", "2=drill:4:118",
        "--cell", "0.5"});
  press({"7"});
  expect_looks_as_it_did("five_axes");
}

TEST_F(WindowPictures, Punch) {
  open({"view", KERF_EXAMPLES "/punch/panel.ngc", "--turret", KERF_CONFIGS "/punch/turret.yaml",
        "--interp", "bridge"},
       {"--stock", "sheet:0,0:400,300:2"});
  press({"7", "End"});
  expect_looks_as_it_did("punch");
}
#endif

TEST_F(WindowPictures, Sheet) {
  const std::string program = folder_.write(
      "cut.ngc",
      "G21 G90 G17 G94\nG0 X50 Y50 Z1.5\nS1 M3\nG1 X300 F3000\nY200\nX50\nY100\nM5\nM2\n");
  open({"view", program, "--kerf", "3", "--at-line", "6"}, {"--stock", "sheet:0,0:400,300:3"});
  press({"7"});
  expect_looks_as_it_did("sheet");
}

TEST_F(WindowPictures, Deviation) {
  open({"view", folder_.write("pocket.ngc", pocket(5.05, "")), "--compare",
        folder_.write("design.stl", design())},
       kPocketWork);
  press({"7", "k", "End"});
  expect_looks_as_it_did("deviation");
}

TEST_F(WindowPictures, Section) {
  open({"view", folder_.write("pocket.ngc", pocket(5, "")), "--at-line", "40"}, kPocketWork,
       "theme = dark\ndark = on\n");
  press({"7", "z"});
  expect_looks_as_it_did("section");
}

/// With a traverse through what is left, so that there is something to be found.
TEST_F(WindowPictures, Light) {
  const std::string fault = "(the way home)\nG0 X5 Y5 Z-2\nG0 Z10\n";
  open({"view", folder_.write("fault.ngc", pocket(5, fault))}, kPocketWork, "theme = light\n");
  press({"7", "End"});
  expect_looks_as_it_did("light");
}

}  // namespace
}  // namespace kerf
