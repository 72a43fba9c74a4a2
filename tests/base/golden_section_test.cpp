#include "base/golden_section.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kerf {
namespace {

/// 0.618^40 of 7 is 3e-8; a square tells places no better than the root of a double's last bit.
TEST(GoldenSectionTest, FindsTheLowestPlace) {
  const auto square = [](double x) { return (x - 1.25) * (x - 1.25) + 3; };
  const LeastWithin found = golden_section(square, -2, 5, 40);
  EXPECT_NEAR(found.middle(), 1.25, 1e-7);
  EXPECT_NEAR(found.least, 3, 1e-12);
  EXPECT_LT(found.high - found.low, 4e-8);
}

TEST(GoldenSectionTest, FindsAnEnd) {
  const auto rises = [](double x) { return std::exp(x); };
  EXPECT_NEAR(golden_section(rises, 2, 3, 30).middle(), 2, 1e-6);
  const auto falls = [](double x) { return -x; };
  EXPECT_NEAR(golden_section(falls, 2, 3, 30).middle(), 3, 1e-6);
}

/// One value for each step, and two to begin with.
TEST(GoldenSectionTest, AsksOnceAStep) {
  int asked = 0;
  golden_section([&](double x) { return ++asked, std::abs(x); }, -1, 1, 10);
  EXPECT_EQ(asked, 12);
}

/// Of a level bottom either end, as is asked for.
TEST(GoldenSectionTest, ATieGoesWhereItIsToldTo) {
  const auto level = [](double) { return 1.0; };
  EXPECT_NEAR(golden_section(level, 0, 1, 30).middle(), 0, 1e-6);
  EXPECT_NEAR(golden_section(level, 0, 1, 30, std::less<>{}).middle(), 1, 1e-6);
}

}  // namespace
}  // namespace kerf
