// base/portable_math.h: near to the truth, and the same bits everywhere.
#include "base/portable_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

namespace kerf {
namespace {

constexpr double kPi = std::numbers::pi;

/// How far from the truth, in units of the last place. The truth is long double's: 11 bits more on
/// a PC, 60 on ARM.
double ulps(double found, long double truth) {
  int exponent = 0;
  std::frexp(static_cast<double>(truth), &exponent);
  return static_cast<double>(std::abs(found - truth) / std::ldexp(1.0L, exponent - 53));
}

/// Evenly from -most to most.
double any(std::mt19937_64& random, double most) {
  return (static_cast<double>(random() >> 11U) * 0x1p-53 * 2 - 1) * most;
}

TEST(PortableMath, IsNearToTheTruth) {
  std::mt19937_64 random(7);
  double sine = 0, cosine = 0, tangent = 0, arc = 0, inverse = 0, length = 0;
  for (int i = 0; i < 400000; ++i) {
    double angle = any(random, i % 3 == 0 ? 1e6 : i % 3 == 1 ? 7 : 1);
    if (i % 7 == 0) angle = std::round(angle / (kPi / 4)) * (kPi / 4);  // where it is hard
    sine = std::max(sine, ulps(portable::sin(angle), std::sin(static_cast<long double>(angle))));
    cosine =
        std::max(cosine, ulps(portable::cos(angle), std::cos(static_cast<long double>(angle))));
    tangent =
        std::max(tangent, ulps(portable::tan(angle), std::tan(static_cast<long double>(angle))));
    const double y = any(random, std::pow(10.0, i % 9 - 4));
    const double x = any(random, 1);
    arc = std::max(arc, ulps(portable::atan2(y, x),
                             std::atan2(static_cast<long double>(y), static_cast<long double>(x))));
    length = std::max(length, ulps(portable::hypot(y, x), std::hypot(static_cast<long double>(y),
                                                                     static_cast<long double>(x))));
    double ratio = any(random, 1);
    if (i % 5 == 0) ratio = std::copysign(1 - std::abs(ratio) * 1e-9, ratio);
    const auto exact = static_cast<long double>(ratio);
    inverse = std::max({inverse, ulps(portable::asin(ratio), std::asin(exact)),
                        ulps(portable::acos(ratio), std::acos(exact))});
  }
  EXPECT_LT(sine, 0.8);
  EXPECT_LT(cosine, 0.8);
  EXPECT_LT(tangent, 2.5);
  EXPECT_LT(arc, 1.6);
  EXPECT_LT(inverse, 2.5);
  EXPECT_LT(length, 1.2);
}

TEST(PortableMath, ExactWhereItCanBe) {
  EXPECT_EQ(portable::sin(0.0), 0.0);
  EXPECT_TRUE(std::signbit(portable::sin(-0.0)));
  EXPECT_EQ(portable::cos(0.0), 1.0);
  EXPECT_EQ(portable::sin(kPi), 0x1.1a62633145c07p-53);  // pi is not a double: this is the rest
  EXPECT_EQ(portable::cos(kPi / 2), 0x1.1a62633145c07p-54);
  EXPECT_EQ(portable::sin(kPi / 2), 1.0);
  EXPECT_EQ(portable::cos(kPi), -1.0);
  EXPECT_EQ(portable::atan2(0.0, -1.0), kPi);
  EXPECT_EQ(portable::atan2(-0.0, -1.0), -kPi);
  EXPECT_EQ(portable::atan2(3.0, 0.0), kPi / 2);
  EXPECT_EQ(portable::atan2(5.0, 5.0), kPi / 4);
  EXPECT_EQ(portable::atan2(0.0, 0.0), 0.0);
  EXPECT_EQ(portable::acos(1.0), 0.0);
  EXPECT_EQ(portable::acos(-1.0), kPi);
  EXPECT_EQ(portable::asin(-1.0), -kPi / 2);
  EXPECT_TRUE(std::isnan(portable::acos(1.0000001)));
  EXPECT_EQ(portable::hypot(3.0, 4.0), 5.0);
  EXPECT_EQ(portable::hypot(2.0, 3.0, 6.0), 7.0);
  EXPECT_EQ(portable::atan2(1e300, 1e300), kPi / 4);
  EXPECT_EQ(portable::atan(std::numeric_limits<double>::infinity()), kPi / 2);
}

/// The number stands for what every processor and compiler has to give.
TEST(PortableMath, HasTheSameBitsEverywhere) {
  std::mt19937_64 random(11);
  std::uint64_t sum = 0xcbf29ce484222325;  // Fowler, Noll, Vo
  const auto add = [&](double value) {
    sum = (sum ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3;
  };
  for (int i = 0; i < 100000; ++i) {
    const double angle = any(random, i % 2 == 0 ? 1e6 : 7);
    const double x = any(random, 1);
    const double y = any(random, 1);
    add(portable::sin(angle));
    add(portable::cos(angle));
    add(portable::tan(angle));
    add(portable::atan2(y, x));
    add(portable::asin(x));
    add(portable::acos(x));
    add(portable::hypot(x, y, angle));
  }
  EXPECT_EQ(sum, 1390668436761409897U);
}

}  // namespace
}  // namespace kerf
