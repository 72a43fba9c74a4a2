// base/axis_turns.h - turning points about the axes of their frame.
#pragma once

#include <cmath>

#include "base/geometry.h"
#include "base/units.h"

namespace kerf {

/// Turned about X, then Y, then Z, through 0, by the right-hand rule. Quarter turns are exact.
inline Vec3 turned_about_axes(const Vec3& p, const Vec3& degrees) {
  Vec3 out = p;
  for (int axis = 0; axis < 3; ++axis) {
    if (degrees[axis] == 0) continue;
    const double quarters = degrees[axis] / 90;
    double c = std::cos(degrees[axis] * kPi / 180), s = std::sin(degrees[axis] * kPi / 180);
    if (quarters == std::round(quarters)) {
      c = std::round(c);
      s = std::round(s);
    }
    const int first = (axis + 1) % 3, second = (axis + 2) % 3;
    const double a = out[first], b = out[second];
    out[first] = c * a - s * b;
    out[second] = s * a + c * b;
  }
  return out;
}

}  // namespace kerf
