// twin/live/rounded_corner.h - a tip beside the path, where the controller rounds a corner.
#pragma once

#include <cstdint>

#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// What a corner has to do with a tip that is beside the path.
enum class RoundedCorner : std::uint8_t {
  kNone,     ///< nothing: the tip is elsewhere, or the controller passes this corner exactly
  kRight,    ///< rounded as the program lets it be: between traverses, or within G64 P
  kByFeeds,  ///< rounded between feeds, by G64 alone: as far as the accelerations want
};

/// The corner between two motions that follow on each other. LinuxCNC begins the second while it
/// ends the first, so the tip is at the corner, less a part of the first, plus a part of the
/// second. Straight motions that turn nothing, both traverses or both feeds; `off_mm`: of the tip,
/// from the nearer one; `tolerance_mm`: from the plane of the two.
RoundedCorner rounded_corner(const Motion& before, const Motion& after, const Vec3& tip_mm,
                             double off_mm, double tolerance_mm);

}  // namespace kerf
