// base/geometry.h - vectors and boxes. Lengths in mm, double precision.
#pragma once

#include <algorithm>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace kerf {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;

inline constexpr double kPi = 3.14159265358979323846;

/// Axis-aligned box, mm. Default-constructed it is empty: min > max, and the first extend() makes
/// it a point.
struct Box {
  Vec3 min{std::numeric_limits<double>::infinity()};
  Vec3 max{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
  Vec3 size() const { return max - min; }
  double volume_mm3() const {
    const Vec3 s = size();
    return empty() ? 0.0 : s.x * s.y * s.z;
  }
  void extend(const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
      min[axis] = std::min(min[axis], p[axis]);
      max[axis] = std::max(max[axis], p[axis]);
    }
  }
  void extend(const Box& other) {
    if (other.empty()) return;
    extend(other.min);
    extend(other.max);
  }
  bool operator==(const Box&) const = default;
};

}  // namespace kerf
