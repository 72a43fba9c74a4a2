// tests/viewer/golden_picture.h - pictures against such that were looked at and found good.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "tests/viewer/png_reader.h"
#include "viewer/picture.h"

namespace kerf::test {

/// One pixel for the mean of a square of `side` each way: drivers differ along edges.
inline Picture shrunk(const Picture& picture, int side) {
  Picture small{picture.width_px / side, picture.height_px / side, {}};
  for (int y = 0; y < small.height_px; ++y) {
    for (int x = 0; x < 3 * small.width_px; ++x) {
      int sum = 0;
      for (int n = 0; n < side * side; ++n) {
        const int row = side * y + n / side, column = side * (x / 3) + n % side;
        sum += picture.rgb[static_cast<std::size_t>(3 * (row * picture.width_px + column) + x % 3)];
      }
      small.rgb.push_back(static_cast<std::uint8_t>(sum / (side * side)));
    }
  }
  return small;
}

/// Mean over the channels of a part of two pictures, of 255.
inline double difference(const Picture& a, const Picture& b, int left, int top, int width,
                         int height) {
  double sum = 0;
  for (int y = top; y < top + height; ++y) {
    for (int x = 3 * left; x < 3 * (left + width); ++x) {
      const std::size_t n = static_cast<std::size_t>(3 * y * a.width_px + x);
      sum += std::abs(a.rgb[n] - b.rgb[n]);
    }
  }
  return sum / (3.0 * width * height);
}

/// `whole`, `part`: what differs at most in all of it, and in each square of kGoldenPart_px. With
/// KERF_UPDATE_GOLDEN the file at `path` is written first.
inline constexpr int kGoldenPart_px = 40;
inline void expect_golden(const Picture& found, const std::string& path, double whole,
                          double part) {
  if (std::getenv("KERF_UPDATE_GOLDEN") != nullptr) {
    const Done done = write_png(path, found);
    ASSERT_TRUE(done) << done.error();
  }
  const Picture golden = read_png_file(path);
  ASSERT_EQ(golden.rgb.size(), found.rgb.size()) << path;
  EXPECT_LT(difference(golden, found, 0, 0, found.width_px, found.height_px), whole) << path;
  for (int y = 0; y + kGoldenPart_px <= found.height_px; y += kGoldenPart_px)
    for (int x = 0; x + kGoldenPart_px <= found.width_px; x += kGoldenPart_px)
      EXPECT_LT(difference(golden, found, x, y, kGoldenPart_px, kGoldenPart_px), part)
          << path << " at " << x << ' ' << y;
}

}  // namespace kerf::test
