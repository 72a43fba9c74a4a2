// interp_bridge/motion_fold_math.h - what the parts of MotionFold share.
#pragma once

#include <cstdint>

#include "base/geometry.h"

namespace kerf {

/// About Z.
inline Vec3 turned(const Vec3& p, double cosine, double sine) {
  return {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, p.z};
}

/// 0.0 for -0.0, which rs274 prints, and which would reach reports.
inline double without_sign_of_zero(double value) { return value + 0.0; }

inline void count_up(std::uint8_t& count) { count += count < 255 ? 1 : 0; }

}  // namespace kerf
