// twin/motion/least_height.h - how low a cutter comes over a point on its way. mm.
#pragma once

#include <limits>

#include "base/geometry.h"
#include "interp_bridge/motion.h"
#include "stock/cutter/cutter.h"

namespace kerf {

/// At the rim of the cutter a point counts as under it: there rounding decides.
inline constexpr double kCutterRim_mm = 1e-9;

/// Height over the middle of the point that the cutter, widened by the tolerance, leaves while its
/// tip is at a place; infinite beside it.
struct LeftHeight {
  const Cutter& cutter;
  Vec2 point_mm;
  double tolerance_mm;

  double at(const Vec3& tip) const;
};

/// The height over the tip is a convex function of the radius: flat, ball, bull, vee, drill.
bool is_convex(const Cutter& cutter);

/// Least height that the motion (a line or an arc) leaves over the point, the tool upright;
/// infinite where it does not come over it. Level ways exactly, straight ones of convex cutters by
/// golden section to 1e-12 of their length; others by samples, 0.02 radii apart, and a search about
/// the lowest of them.
double least_height(const Motion& m, const LeftHeight& left, bool convex);

}  // namespace kerf
