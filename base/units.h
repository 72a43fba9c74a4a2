// base/units.h - what one unit is in another. Names carry the unit that they lead to and from.
#pragma once

namespace kerf {

/// Exact since 1959.
inline constexpr double kMmPerInch = 25.4;

/// `angle_deg * kRadPerDeg` and `angle_deg * kPi / 180` (geometry.h) may differ in the last bit.
inline constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;
inline constexpr double kDegPerRad = 180.0 / 3.14159265358979323846;

/// mm in one unit of a machine or a file that counts either in inches or in mm.
constexpr double mm_of_unit(bool is_inch) { return is_inch ? kMmPerInch : 1.0; }

}  // namespace kerf
