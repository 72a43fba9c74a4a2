// stock/zmap/cutter_components.h - any cutter without undercut as a union of convex tools.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "stock/cutter/cutter.h"
#include "stock/zmap/sweep_ops.h"

namespace kerf {

/// Hollow (concave) arcs of a profile become lines that deviate by at most this, mm.
inline constexpr double kProfileChord_mm = 0.0005;

/// Divides a profile (Cutter::profile(), radius and height not falling) wherever its slope falls (a
/// step drill, a hollow arc): each part, carried level to the axis, is a convex tool, and together
/// they sweep exactly what lies above the profile. Cost: one pass of the kernel each.
std::vector<ConvexTool> convex_components(std::span<const ProfilePiece> profile);

/// Error if the lower side of the cutter falls somewhere on its way outward: `model` ("a Z-map")
/// cannot cut with it.
Done check_bottom(const Cutter& cutter, const std::string& model);

/// Height of the tool's surface above its tip at distance d <= tool.radius from the axis, mm.
double surface_height(const ConvexTool& tool, double d);

}  // namespace kerf
