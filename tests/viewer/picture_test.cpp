#include "viewer/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/viewer/test_meshes.h"

/// AddressSanitizer holds back 256 MB of what was freed, which the test of memory below would count
/// as used. Here it holds back less.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "quarantine_size_mb=16"; }

namespace kerf {
namespace {

const Box kBlank{{-50, -50, -50}, {50, 50, 0}};
/// Of two pictures: below this two pixels count as the same colour.
constexpr int kSameColor = 6;

struct Color {
  int r, g, b;
  int brightness() const { return (r + g + b) / 3; }
};

/// Position in shares of width and height, from the upper left.
Color at(const Picture& picture, double x, double y) {
  const auto column = static_cast<std::size_t>(x * (picture.width_px - 1));
  const auto row = static_cast<std::size_t>(y * (picture.height_px - 1));
  const std::size_t i = (row * static_cast<std::size_t>(picture.width_px) + column) * 3;
  return {picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
}

bool same(const Color& a, const Color& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}) <= kSameColor;
}

/// Pixels of the given share of the picture that satisfy `test`.
template <class Test>
int count(const Picture& picture, double x0, double y0, double x1, double y1, const Test& test) {
  int n = 0;
  for (int y = static_cast<int>(y0 * picture.height_px); y < y1 * picture.height_px; ++y) {
    for (int x = static_cast<int>(x0 * picture.width_px); x < x1 * picture.width_px; ++x) {
      const std::size_t i =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width_px) +
               static_cast<std::size_t>(x));
      n += test(Color{picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]}) ? 1 : 0;
    }
  }
  return n;
}

bool is_red(const Color& c) { return c.r > 150 && c.g < 90 && c.b < 90; }
bool is_green(const Color& c) { return c.g > 100 && c.r < 70 && c.b < 90; }
bool is_blue(const Color& c) { return c.b > 150 && c.r < 80 && c.g < 110; }

PictureOptions options_of(int width_px, int height_px) {
  PictureOptions options;
  options.width_px = width_px;
  options.height_px = height_px;
  options.blank_mm = kBlank;
  return options;
}

Picture draw(const TriangleMesh& mesh, const PictureOptions& options) {
  Result<Picture> picture = draw_part(part_of(mesh), options);
  if (!picture) {
    ADD_FAILURE() << picture.error();
    return {};
  }
  return std::move(*picture);
}

/// No display: the pictures must not need one.
class PictureTest : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
  }
};

TEST_F(PictureTest, BoxHasThreeFacesOnALightBackground) {
  const Picture picture = draw(box_mesh(kBlank), options_of(640, 480));
  ASSERT_EQ(picture.width_px, 640);
  ASSERT_EQ(picture.height_px, 480);
  ASSERT_EQ(picture.rgb.size(), 640u * 480u * 3u);
  for (const double x : {0.0, 1.0}) {
    EXPECT_TRUE(same(at(picture, x, 0.0), {200, 208, 217})) << x;
    EXPECT_TRUE(same(at(picture, x, 1.0), {243, 245, 246})) << x;
  }
  const Color top = at(picture, 0.40, 0.25);
  const Color front = at(picture, 0.40, 0.62);
  const Color right = at(picture, 0.76, 0.60);
  EXPECT_GT(top.brightness(), front.brightness() + 25);
  EXPECT_GT(front.brightness(), right.brightness() + 5);
  EXPECT_GT(right.brightness(), 70);
}

/// The hatching of a section's face: brown, where the axes are red, green, blue and parts grey.
bool is_hatched(const Color& c) { return c.r > c.g + 25 && c.g > c.b + 25; }

/// The front half is away: at the place of the front there is the face, and nothing is hatched
/// without a section.
TEST_F(PictureTest, ASectionIsHatched) {
  PictureOptions options = options_of(640, 480);
  const Picture whole = draw(box_mesh(kBlank), options);
  const auto hatched = [](const Picture& picture) {
    return count(picture, 0.1, 0.2, 0.9, 0.9, is_hatched);
  };
  EXPECT_EQ(hatched(whole), 0);
  options.section = SectionKind::kHalf;
  const Picture half = draw(box_mesh(kBlank), options);
  // 100 x 50 mm, seen at 46 degrees to its normal, of a picture of some 200 x 150 mm.
  EXPECT_NEAR(hatched(half), 0.12 * 640 * 480, 0.03 * 640 * 480);
  options.section = SectionKind::kQuarter;
  const Picture quarter = draw(box_mesh(kBlank), options);
  EXPECT_GT(hatched(quarter), hatched(half) / 2);
  EXPECT_NE(quarter.rgb, half.rgb);
}

/// A bar in a lathe lies: it is longer than it is high in the picture.
TEST_F(PictureTest, ATurnedPartLiesWithItsAxisToTheRight) {
  const Box bar{{-10, -10, -100}, {10, 10, 0}};
  PictureOptions options = options_of(640, 480);
  options.blank_mm = bar;
  options.standing = Standing::kInLathe;
  const Picture lying = draw(box_mesh(bar), options);
  // Blue Z points right of the red X.
  const auto mean_x = [&](auto is_color) {
    double sum = 0;
    int n = 0;
    for (int x = 0; x < lying.width_px; ++x) {
      const double share = static_cast<double>(x) / lying.width_px;
      const int here = count(lying, share, 0, share + 1.0 / lying.width_px, 1, is_color);
      sum += here * share;
      n += here;
    }
    EXPECT_GT(n, 20);
    return sum / std::max(1, n);
  };
  EXPECT_GT(mean_x(is_blue), mean_x(is_red) + 0.02);
}

TEST_F(PictureTest, SameInputGivesTheSamePixels) {
  const TriangleMesh mesh = relief_mesh(60);
  const PictureOptions options = options_of(320, 240);
  EXPECT_EQ(draw(mesh, options).rgb, draw(mesh, options).rgb);
}

TEST_F(PictureTest, OddSizesAreDrawnWhole) {
  for (const auto& [width, height] : {std::pair{321, 243}, std::pair{64, 64}, std::pair{65, 401}}) {
    const Picture picture = draw(box_mesh(kBlank), options_of(width, height));
    ASSERT_EQ(picture.rgb.size(), static_cast<std::size_t>(width * height * 3));
    EXPECT_TRUE(same(at(picture, 1.0, 1.0), {243, 245, 246}));
    EXPECT_TRUE(same(at(picture, 0.0, 0.0), {200, 208, 217}));
  }
}

TEST_F(PictureTest, EmptyMeshShowsTheOutlineOnly) {
  const Picture empty = draw(TriangleMesh{}, options_of(640, 480));
  const Picture full = draw(box_mesh(kBlank), options_of(640, 480));
  // Inside the outline there is background, where the full box has its front and right faces.
  for (const auto& [x, y] : {std::pair{0.40, 0.68}, std::pair{0.80, 0.50}}) {
    EXPECT_TRUE(same(at(empty, x, y), at(empty, 0.0, y))) << x;
    EXPECT_FALSE(same(at(full, x, y), at(full, 0.0, y))) << x;
  }
  const auto darker = [](const Color& c) { return c.brightness() < 180; };
  EXPECT_GT(count(empty, 0.13, 0.3, 0.9, 0.95, darker), 300);
}

/// A box of 40 mm about `middle`.
PictureBody body_at(const glm::vec3& middle) {
  PictureBody body;
  body.mesh = std::make_shared<const TriangleMesh>(box_mesh({Vec3(-20), Vec3(20)}));
  body.pose[3] = glm::vec4(middle, 1.0f);
  body.color = 0xff2020e0;
  return body;
}

TEST_F(PictureTest, WhatStandsBeforeThePartIsSeenThrough) {
  const TriangleMesh mesh = box_mesh(kBlank);
  PictureOptions options = options_of(640, 480);
  options.bodies = {body_at({0, 0, 60})};  // above it
  const auto reddish = [](const Color& c) { return c.r > c.b + 40; };
  EXPECT_GT(count(draw(mesh, options), 0, 0, 1, 1, reddish), 2000);
  // In it: the part hides it.
  options.bodies = {body_at({0, 0, -25})};
  EXPECT_LT(count(draw(mesh, options), 0, 0, 1, 1, reddish),
            50 + count(draw(mesh, options_of(640, 480)), 0, 0, 1, 1, reddish));
}

TEST_F(PictureTest, AFarBodyDoesNotMakeThePartSmall) {
  const TriangleMesh mesh = box_mesh(kBlank);
  PictureOptions far = options_of(640, 480);
  far.bodies = {body_at({0, 0, 5000})};
  const Picture with = draw(mesh, far), without = draw(mesh, options_of(640, 480));
  EXPECT_EQ(with.rgb, without.rgb);
}

TEST_F(PictureTest, NothingToDrawIsAnError) {
  PictureOptions options;
  const Result<Picture> picture = draw_part(PartPatches{}, options);
  ASSERT_FALSE(picture);
  EXPECT_EQ(picture.error(), "nothing to draw: the part is empty and no blank is given");
}

TEST_F(PictureTest, MeshWithoutBlankIsFittedByItself) {
  PictureOptions options;
  options.width_px = 320;
  options.height_px = 240;
  const Picture picture = draw(box_mesh(Box{{1000, 1000, 0}, {1010, 1010, 5}}), options);
  EXPECT_FALSE(same(at(picture, 0.5, 0.6), at(picture, 0.0, 0.6)));
}

TEST_F(PictureTest, SizesOutOfRangeAreErrors) {
  for (const auto& [width, height] :
       {std::pair{0, 1200}, std::pair{1600, -1}, std::pair{8193, 100}}) {
    const Result<Picture> picture = draw_part(part_of(box_mesh(kBlank)), options_of(width, height));
    ASSERT_FALSE(picture);
    EXPECT_EQ(picture.error(), "a picture of " + std::to_string(width) + " x " +
                                   std::to_string(height) +
                                   " pixels is not allowed; each side must be 64 to 8192");
  }
}

TEST_F(PictureTest, AxesAreAtTheOriginOrInTheCorner) {
  const Picture near = draw(box_mesh(kBlank), options_of(800, 600));
  EXPECT_GT(count(near, 0.45, 0.1, 0.75, 0.4, is_red), 50);
  EXPECT_GT(count(near, 0.45, 0.1, 0.75, 0.4, is_green), 50);
  EXPECT_GT(count(near, 0.45, 0.1, 0.75, 0.4, is_blue), 50);
  EXPECT_EQ(count(near, 0.8, 0.8, 1.0, 1.0, is_red), 0);

  PictureOptions options = options_of(800, 600);
  options.blank_mm = Box{{950, 950, 0}, {1050, 1050, 50}};
  const Picture far = draw(box_mesh(options.blank_mm), options);
  EXPECT_GT(count(far, 0.8, 0.75, 1.0, 1.0, is_red), 20);
  EXPECT_EQ(count(far, 0.2, 0.0, 0.8, 0.7, is_red), 0);
}

TEST_F(PictureTest, CaptionStandsAtTheLowerLeftAndNowhereElse) {
  PictureOptions options = options_of(640, 480);
  const Picture without = draw(box_mesh(kBlank), options);
  options.caption = "3D_Chips.ngc  zmap 0.05 mm";
  const Picture with = draw(box_mesh(kBlank), options);
  int inside = 0;
  int outside = 0;
  for (std::size_t i = 0; i < with.rgb.size(); i += 3) {
    if (with.rgb[i] == without.rgb[i]) continue;
    const std::size_t x = i / 3 % 640, y = i / 3 / 640;
    (x < 320 && y > 440 ? inside : outside) += 1;
  }
  EXPECT_GT(inside, 200);
  EXPECT_EQ(outside, 0);
}

TEST_F(PictureTest, LongCaptionIsMadeToFit) {
  PictureOptions options = options_of(320, 240);
  options.caption = std::string(400, 'W');
  const Picture picture = draw(box_mesh(kBlank), options);
  const auto dark = [](const Color& c) { return c.brightness() < 150; };
  EXPECT_EQ(count(picture, 0.985, 0.9, 1.0, 1.0, dark), 0);
}

/// Most of the blank cut away: its upper edges stand free over the part.
TEST_F(PictureTest, OutlineStandsWherePartIsCutAway) {
  const Picture full = draw(box_mesh(kBlank), options_of(640, 480));
  const Picture low = draw(box_mesh(Box{{-50, -50, -50}, {50, 50, -40}}), options_of(640, 480));
  EXPECT_FALSE(same(at(full, 0.40, 0.40), at(full, 0.0, 0.40)));  // top of the front face
  const auto outline = [](const Color& c) { return c.b > c.r + 35; };
  EXPECT_GT(count(low, 0.15, 0.05, 0.9, 0.30, outline), 100);
}

using PictureDeathTest = PictureTest;

/// Lines along the edges of terraces that lie as close as the lines are wide leave nothing to be
/// seen; along those of a few they tell where they are.
TEST_F(PictureTest, CloseTerracesAreNotBlack) {
  PictureOptions options = options_of(1600, 1200);
  options.blank_mm = Box{{0, 0, -50}, {100, 100, 0}};
  const auto dark_pixels = [&](double period_mm) {
    const Picture picture = draw(terrace_mesh(800, period_mm), options);
    return count(picture, 0.35, 0.35, 0.65, 0.6,
                 [](const Color& c) { return c.brightness() < 90; });
  };
  const int all = 1600 * 1200 * 30 / 100 * 25 / 100;
  EXPECT_LT(dark_pixels(1.2), all / 50);
  EXPECT_GT(dark_pixels(20.0), all / 500);
}

/// Of this process since begin_peak(), in MB.
double peak_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "VmHWM:") continue;
    double kb = 0.0;
    status >> kb;
    return kb / 1024.0;
  }
  return 0.0;
}

void begin_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

TEST_F(PictureTest, ManyTrianglesTakeNoMoreMemoryThanFew) {
  const PictureOptions options = options_of(1600, 1200);
  PartPatches part = part_of(relief_mesh(140));
  const auto peak_of = [&](std::size_t patches) {
    part.count = patches;
    begin_peak();
    EXPECT_TRUE(draw_part(part, options));
    return peak_mb();
  };
  const double few_mb = peak_of(1);
  ASSERT_GT(few_mb, 0.0);
  const double many_mb = peak_of(100);
  EXPECT_LT(many_mb, few_mb + 40.0);
}

TEST_F(PictureDeathTest, WithoutAnyDriverTheErrorSaysWhatToInstall) {
  // Runs in a fresh process, so that the EGL loader has not yet looked for its drivers.
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
        unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
        const Result<Picture> picture = draw_part(part_of(box_mesh(kBlank)), options_of(64, 64));
        if (!picture) fprintf(stderr, "[%s]\n", picture.error().c_str());
        exit(picture ? 0 : 7);
      },
      testing::ExitedWithCode(7),
      "\\[no OpenGL for pictures: .*Debian packages: libegl1 libegl-mesa0 libgl1-mesa-dri");
}

/// Means of 4 x 4 blocks.
Picture shrink(const Picture& picture) {
  Picture small{picture.width_px / 4, picture.height_px / 4, {}};
  const auto stride = static_cast<std::size_t>(picture.width_px) * 3;
  for (std::size_t y = 0; y < static_cast<std::size_t>(small.height_px); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(small.width_px) * 3; ++x) {
      int sum = 0;
      for (std::size_t j = 0; j < 4; ++j) {
        for (std::size_t i = 0; i < 4; ++i) {
          sum += picture.rgb[(4 * y + j) * stride + 3 * (4 * (x / 3) + i) + x % 3];
        }
      }
      small.rgb.push_back(static_cast<std::uint8_t>(sum / 16));
    }
  }
  return small;
}

/// Against a picture that was looked at and found good. After a wanted change of the looks:
///     KERF_UPDATE_GOLDEN=1 ctest -R PictureTest.LooksAsItDid
/// then look at tests/golden/part_picture.png before it is committed.
TEST_F(PictureTest, LooksAsItDid) {
  // Drivers differ in the last bits and along edges: mean difference allowed per channel, of 255.
  constexpr double kMeanDifference = 1.5;
  const std::string path = std::string(KERF_GOLDEN_FOLDER) + "/part_picture.png";
  PictureOptions options = options_of(640, 480);
  options.blank_mm = Box{{0, 0, -30}, {100, 100, 0}};
  options.caption = "relief.ngc";
  const Picture found = shrink(draw(relief_mesh(250), options));
  if (std::getenv("KERF_UPDATE_GOLDEN") != nullptr) {
    const Done done = write_png(path, found);
    ASSERT_TRUE(done) << done.error();
  }
  const Picture golden = read_png(path);
  ASSERT_EQ(golden.rgb.size(), found.rgb.size()) << path;
  double sum = 0.0;
  for (std::size_t i = 0; i < golden.rgb.size(); ++i) sum += std::abs(golden.rgb[i] - found.rgb[i]);
  EXPECT_LT(sum / static_cast<double>(golden.rgb.size()), kMeanDifference);
}

}  // namespace
}  // namespace kerf
