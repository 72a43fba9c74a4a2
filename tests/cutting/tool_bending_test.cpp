// How far tools bend, against the rod's closed form.
#include "cutting/tool_bending.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geometry.h"

namespace kerf {
namespace {

double inertia(double diameter) { return kPi / 64 * std::pow(diameter, 4); }

/// F L^3 / (3 E I) at the tip; at `a` above it F b^2 (3 L - b) / (6 E I), b = L - a.
TEST(ToolBending, OneRodIsTheTextbooksOne) {
  const ToolRods rods{10, 10, 0, 40, kCarbideModulus};
  EXPECT_NEAR(tip_bends_mm_per_n(rods, 0), 40.0 * 40 * 40 / (3 * kCarbideModulus * inertia(10)),
              1e-12);
  const double b = 40 - 6;
  EXPECT_NEAR(tip_bends_mm_per_n(rods, 6),
              b * b * (3 * 40 - b) / (6 * kCarbideModulus * inertia(10)), 1e-12);
}

/// All flutes: as a rod of 0.8 of the diameter, so 1 / 0.8^4 = 2.44 times as far. A tool of 6 mm,
/// 20 mm out of the holder, pushed by 100 N: 100 * 8000 / (3 * 600000 * 26.06) = 0.017 mm.
TEST(ToolBending, FlutesAreWeaker) {
  const ToolRods rods{6, 6, 20, 20, kCarbideModulus};
  EXPECT_NEAR(100 * tip_bends_mm_per_n(rods, 0), 0.0171, 1e-4);
  const ToolRods shank{6, 6, 0, 20, kCarbideModulus};
  EXPECT_NEAR(tip_bends_mm_per_n(rods, 0) / tip_bends_mm_per_n(shank, 0), 1 / std::pow(0.8, 4),
              1e-9);
}

/// Two rods against many thin slices of the moment.
TEST(ToolBending, TwoRodsAreTheSumOfTheirSlices) {
  const ToolRods rods{6, 10, 18, 45, kSteelModulus};
  for (const double at : {0.0, 4.0, 25.0}) {
    double sum = 0;
    constexpr int kSlices = 100'000;
    for (int k = 0; k < kSlices; ++k) {
      const double x = 45 * (k + 0.5) / kSlices;
      if (x < at) continue;
      sum += (x - at) * x / (kSteelModulus * inertia(x < 18 ? 4.8 : 10)) * 45 / kSlices;
    }
    EXPECT_NEAR(tip_bends_mm_per_n(rods, at), sum, 1e-4 * sum);
  }
  EXPECT_EQ(tip_bends_mm_per_n(rods, 45), 0);
}

}  // namespace
}  // namespace kerf
