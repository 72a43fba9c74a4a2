#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/base/temporary_folder.h"
#include "tests/viewer/test_meshes.h"
#include "viewer/png_image.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

/// Every channel and row different, no symmetry.
Picture test_picture(int width_px, int height_px) {
  Picture picture{width_px, height_px, {}};
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      for (int c = 0; c < 3; ++c) {
        picture.rgb.push_back(static_cast<std::uint8_t>((x * 7 + y * 31 + c * 80 + x * y) & 255));
      }
    }
  }
  return picture;
}

class PngTest : public testing::Test {
 protected:
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  const TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(PngTest, ReadsBackUnchanged) {
  const std::string path = (folder_ / "part.png").string();
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{3, 2}, std::pair{257, 131}}) {
    const Picture picture = test_picture(width, height);
    const Done done = write_png(path, picture);
    ASSERT_TRUE(done) << done.error();
    const Picture back = read_png(path);
    EXPECT_EQ(back.width_px, width);
    EXPECT_EQ(back.height_px, height);
    EXPECT_EQ(back.rgb, picture.rgb);
    EXPECT_EQ(files(), 1u);  // replaced, and no temporary file left
  }
}

TEST_F(PngTest, SamePictureSameBytes) {
  const Picture picture = test_picture(100, 80);
  const auto first = encode_png(picture);
  const auto second = encode_png(picture);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, *second);
}

TEST_F(PngTest, FolderThatDoesNotExistIsAnErrorThatNamesTheFile) {
  const std::string path = (folder_ / "nowhere" / "part.png").string();
  const Done done = write_png(path, test_picture(4, 4));
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().find(path), std::string::npos) << done.error();
  EXPECT_NE(done.error().find("No such file or directory"), std::string::npos) << done.error();
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace kerf
