// base/triple.h - three numbers that are compared with each motion.
#pragma once

#include <array>

#include "base/geometry.h"

namespace kerf {

/// As ==, with one branch and not three: they are equal nearly always.
inline bool is_equal(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return (int{a[0] == b[0]} & int{a[1] == b[1]} & int{a[2] == b[2]}) != 0;
}
inline bool is_equal(const Vec3& a, const Vec3& b) {
  return (int{a.x == b.x} & int{a.y == b.y} & int{a.z == b.z}) != 0;
}

}  // namespace kerf
