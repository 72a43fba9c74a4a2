#include "base/portable_math.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace kerf::portable {
namespace {

// pi / 2 in parts: the first three have 33 bits, so that their products with a whole number below
// 2^20 are exact (W. J. Cody, W. Waite, "Software Manual for the Elementary Functions", 1980).
constexpr double kHalfPi1 = 0x1.921fb544p+0;
constexpr double kHalfPi2 = 0x1.0b4611a6p-34;
constexpr double kHalfPi3 = 0x1.3198a2ep-69;
constexpr double kHalfPi4 = 0x1.b839a252049c1p-104;
constexpr double kTwoByPi = 0x1.45f306dc9c883p-1;
constexpr double kLargestAngle_rad = 1e6;
constexpr double kLongest = 1e290;

/// An angle as quarter turns and what is left of it: `rest` + `low`, at most a little over pi / 4.
struct Reduced {
  int quarters;  // 0 .. 3
  double rest, low;
};

Reduced reduced(double angle_rad) {
  const double turns = std::floor(angle_rad * kTwoByPi + 0.5);
  const double first = angle_rad - turns * kHalfPi1;  // exact
  const double second = turns * kHalfPi2;
  const double middle = first - second;
  const double lost = (first - middle) - second;
  const double third = turns * kHalfPi3;
  const double high = middle - third;
  const double low = ((middle - high) - third) + lost - turns * kHalfPi4;
  const double rest = high + low;
  return {static_cast<int>(static_cast<long long>(turns) & 3), rest, (high - rest) + low};
}

// Taylor's series: the next term is below 2^-60 of the sum.
double sin_of(double x, double low) {
  const double z = x * x;
  const double tail =
      z * (0x1.1111111111111p-7 +
           z * (-0x1.a01a01a01a01ap-13 +
                z * (0x1.71de3a556c734p-19 +
                     z * (-0x1.ae64567f544e4p-26 +
                          z * (0x1.6124613a86d09p-33 +
                               z * (-0x1.ae7f3e733b81fp-41 + z * 0x1.952c77030ad4ap-49))))));
  const double cube = z * x;
  return x + (cube * (-0x1.5555555555555p-3 + tail) + low * (1.0 - 0.5 * z));
}

double cos_of(double x, double low) {
  const double z = x * x;
  const double tail =
      z * z *
      (0x1.5555555555555p-5 +
       z * (-0x1.6c16c16c16c17p-10 +
            z * (0x1.a01a01a01a01ap-16 +
                 z * (-0x1.27e4fb7789f5cp-22 +
                      z * (0x1.1eed8eff8d898p-29 +
                           z * (-0x1.93974a8c07c9dp-37 +
                                z * (0x1.ae7f3e733b81fp-45 + z * -0x1.6827863b97d97p-53)))))));
  const double half = 0.5 * z;
  const double most = 1.0 - half;
  return most + (((1.0 - most) - half) + (tail - x * low));
}

/// The halves of a double, whose products are exact (T. J. Dekker, "A floating-point technique for
/// extending the available precision", 1971).
struct Halves {
  double high, low;
};
Halves halves(double value) {
  const double shifted = value * 0x1.0p27;
  const double high = (value + shifted) - shifted;
  return {high, value - high};
}

struct Angle {
  double high, low;
};
/// atan(k / 16).
constexpr std::array<Angle, 17> kAngles{{
    {0, 0},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
}};
constexpr Angle kHalfTurn{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr Angle kQuarterTurn{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

/// atan(y / x) for 0 <= y <= x, x > 0: the nearest k / 16, and the little angle from there by its
/// series.
Angle atan_of(double y, double x) {
  const int k = static_cast<int>(y / x * 16.0 + 0.5);
  const double slope = k / 16.0;
  // y - slope * x: slope has five bits, so both products are exact.
  const Halves parts = halves(x);
  const double across = (y - slope * parts.high) - slope * parts.low;
  const double z = across / (x + slope * y);
  const double s = z * z;
  const double series =
      z * s *
      (-0x1.5555555555555p-2 +
       s * (0x1.999999999999ap-3 +
            s * (-0x1.2492492492492p-3 + s * (0x1.c71c71c71c71cp-4 + s * -0x1.745d1745d1746p-4))));
  const Angle& start = kAngles[static_cast<std::size_t>(k)];
  return {start.high, start.low + series + z};
}

/// whole - part.
Angle minus(const Angle& whole, const Angle& part) {
  const double high = whole.high - part.high;
  return {high, ((whole.high - high) - part.high) + (whole.low - part.low)};
}

}  // namespace

SinCos sin_cos(double angle_rad) { return {sin(angle_rad), cos(angle_rad)}; }

double sin(double angle_rad) {
  if (!(std::abs(angle_rad) <= kLargestAngle_rad)) return std::sin(angle_rad);
  if (angle_rad == 0) return angle_rad;  // with its sign
  const Reduced r = reduced(angle_rad);
  const double value = (r.quarters & 1) != 0 ? cos_of(r.rest, r.low) : sin_of(r.rest, r.low);
  return r.quarters >= 2 ? -value : value;
}

double cos(double angle_rad) {
  if (!(std::abs(angle_rad) <= kLargestAngle_rad)) return std::cos(angle_rad);
  const Reduced r = reduced(angle_rad);
  const double value = (r.quarters & 1) != 0 ? sin_of(r.rest, r.low) : cos_of(r.rest, r.low);
  return r.quarters == 1 || r.quarters == 2 ? -value : value;
}

double tan(double angle_rad) { return sin(angle_rad) / cos(angle_rad); }

double atan2(double y, double x) {
  const double up = std::abs(y);
  const double along = std::abs(x);
  // Of these the C library has but one value each; and nothing here is as long as the longest.
  if (!(up < kLongest && along < kLongest) || up == 0 || along == 0) return std::atan2(y, x);
  Angle angle = up <= along ? atan_of(up, along) : minus(kQuarterTurn, atan_of(along, up));
  if (std::signbit(x)) angle = minus(kHalfTurn, angle);
  return std::copysign(angle.high + angle.low, y);
}

double atan(double x) { return atan2(x, 1.0); }

double asin(double x) { return atan2(x, std::sqrt((1.0 - x) * (1.0 + x))); }

double acos(double x) { return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x); }

double hypot(double x, double y) { return std::sqrt(x * x + y * y); }

double hypot(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

}  // namespace kerf::portable
