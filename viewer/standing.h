// viewer/standing.h - which way up a workpiece is looked at.
#pragma once

#include <cstdint>

#include "base/geometry.h"

namespace kerf {

/// Views ("front", "top") are named in a frame of their own: x to the right, z up, seen from -y.
/// How that lies in the workpiece frame:
///
///     kOnTable      x is X   z is Z   the eye at -Y    a mill
///     kInLathe      x is Z   z is X   the eye at +Y    a turned part, as lathes' screens show it
///     kOnLatheBed   x is Z   z is Y   the eye at -X    the lathe around it, which stands on Y
enum class Standing : std::uint8_t { kOnTable, kInLathe, kOnLatheBed };

/// From the frame of views to that of the workpiece.
constexpr Vec3 in_workpiece(const Vec3& v, Standing standing) {
  switch (standing) {
    case Standing::kInLathe:
      return {v.z, -v.y, v.x};
    case Standing::kOnLatheBed:
      return {v.y, v.z, v.x};
    case Standing::kOnTable:
      break;
  }
  return v;
}

/// Up in the picture, but for what one looks down on.
constexpr Vec3 up_of(Standing standing) { return in_workpiece({0, 0, 1}, standing); }

}  // namespace kerf
