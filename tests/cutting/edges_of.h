// tests/cutting/edges_of.h - outlines of cutters for tests of cutting/.
#pragma once

#include <cmath>
#include <vector>

#include "base/geometry.h"

namespace kerf {

/// A flat bottom of `flat_mm`, then an arc up to the radius.
inline std::vector<Vec2> bull_outline(double radius_mm, double corner_mm) {
  std::vector<Vec2> out{{0, 0}};
  for (int k = 0; k <= 400; ++k) {
    const double angle = kPi / 2 * k / 400;
    out.emplace_back(radius_mm - corner_mm + corner_mm * std::sin(angle),
                     corner_mm * (1 - std::cos(angle)));
  }
  return out;
}

inline std::vector<Vec2> ball_outline(double radius_mm) {
  return bull_outline(radius_mm, radius_mm);
}

/// `half_rad` from the axis.
inline std::vector<Vec2> vee_outline(double radius_mm, double half_rad) {
  return {{0, 0}, {radius_mm, radius_mm / std::tan(half_rad)}};
}

}  // namespace kerf
