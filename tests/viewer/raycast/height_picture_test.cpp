// The picture of a part without OpenGL, against the one that OpenGL draws of its patches.
#include "viewer/raycast/height_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/stock/random_part.h"
#include "tests/viewer/raycast/sample_grids.h"
#include "viewer/raycast/stroke_raster.h"

namespace kerf {
namespace {

/// Written where KERF_PICTURE_FOLDER says, to be looked at.
void show(const std::string& name, const Picture& picture) {
  const char* const folder = std::getenv("KERF_PICTURE_FOLDER");
  if (folder == nullptr) return;
  const Done done = write_png(std::string(folder) + "/" + name, picture);
  EXPECT_TRUE(done) << done.error();
}

TEST(HeightPicture, LooksLikeTheOneOfThePatches) {
  unsetenv("DISPLAY");
  const std::unique_ptr<ZMap> part = test::random_part(3, 0.1);
  PictureOptions options;
  options.width_px = 800;
  options.height_px = 600;
  options.blank_mm = part->bounds_mm();
  options.caption = "part.ngc  zmap 0.1 mm";
  const Result<Picture> rays = draw_heights(part->height_grid(), options);
  ASSERT_TRUE(rays) << rays.error();
  const auto patch = [&](std::size_t tile, double) {
    return part->patch(static_cast<std::uint32_t>(tile), 0);
  };
  const Result<Picture> meshes = draw_part({part->bounds_mm(), part->tile_count(), patch}, options);
  ASSERT_TRUE(meshes) << meshes.error();
  show("rays.png", *rays);
  show("meshes.png", *meshes);
  ASSERT_EQ(rays->rgb.size(), meshes->rgb.size());
  std::size_t alike = 0;
  double sum = 0;
  for (std::size_t n = 0; n < rays->rgb.size(); ++n) {
    const int difference = std::abs(int{rays->rgb[n]} - int{meshes->rgb[n]});
    sum += difference;
    alike += difference <= 6;
  }
  const auto count = static_cast<double>(rays->rgb.size());
  EXPECT_LT(sum / count, 2.0);
  EXPECT_GT(static_cast<double>(alike) / count, 0.93);
}

TEST(HeightPicture, IsTheSameForAnyNumberOfThreads) {
  const std::unique_ptr<ZMap> part = test::random_part(5, 0.2, true);
  PictureOptions options;
  options.width_px = 200;
  options.height_px = 150;
  const Result<Picture> one = draw_heights(part->height_grid(), options, 1);
  const Result<Picture> three = draw_heights(part->height_grid(), options, 3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->rgb, three->rgb);
}

TEST(HeightPicture, NothingAndWrongSizesAreErrors) {
  const auto nothing =
      test::make_grid({Vec3(0), Vec3(10)}, 20, 20, [](double, double) { return 0; });
  PictureOptions options;
  const Result<Picture> empty = draw_heights(nothing, options);
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error(), "nothing to draw: the part is empty and no blank is given");
  options.blank_mm = {Vec3(0), Vec3(10)};
  options.width_px = 64;
  options.height_px = 64;
  EXPECT_TRUE(draw_heights(nothing, options));
  options.height_px = 63;
  const Result<Picture> small = draw_heights(nothing, options);
  ASSERT_FALSE(small);
  EXPECT_EQ(small.error(),
            "a picture of 64 x 63 pixels is not allowed; each side must be 64 to 8192");
}

TEST(StrokeRaster, CoversItsWidthAndHidesBehindThePart) {
  Picture picture{40, 20, std::vector<std::uint8_t>(3 * 40 * 20, 255)};
  std::vector<float> depths(40 * 20, 1.0f);
  for (std::size_t y = 0; y < 20; ++y)
    for (std::size_t x = 20; x < 40; ++x) depths[y * 40 + x] = 0.2f;
  const Stroke stroke{{5, 10}, {35, 10}, 0.5f, 0.5f, 4.0f, {0, 0, 0, 1}, 0.25f};
  draw_strokes(std::span(&stroke, 1), depths, &picture);
  const auto gray = [&](std::size_t x, std::size_t y) {
    return int{picture.rgb[3 * (y * 40 + x)]};
  };
  for (const std::size_t y : {8u, 9u, 10u, 11u}) {
    EXPECT_EQ(gray(12, y), 0) << y;
    EXPECT_NEAR(gray(28, y), 191, 1) << y;  // a quarter
  }
  for (const std::size_t y : {6u, 13u}) EXPECT_EQ(gray(12, y), 255) << y;
  EXPECT_EQ(gray(1, 10), 255);
  EXPECT_EQ(gray(38, 10), 255);
}

}  // namespace
}  // namespace kerf
