// viewer/csg/convex_profile.h - what of a tool's outline cuts from above, in convex pieces.
#pragma once

#include <span>
#include <vector>

#include "base/geometry.h"
#include "base/result.h"
#include "viewer/scene.h"

namespace kerf {

/// Lower boundary of a convex solid of revolution that is open upwards: points (radius, height
/// above the tip) in mm, radii and slopes never falling.
///
///       |                 |   no end above
///       |      solid     /
///       |             _.'     slopes grow outwards
///       +-----------'         flat within the first radius (which may be 0)
///      axis
using ConvexProfile = std::vector<Vec2>;

/// The region {z >= f(r)} above an outline, as convex pieces whose union it is. f(r) is the least
/// height at which the outline reaches radius r, so undercuts (lollipop, T-slot, the back of a
/// dovetail) come out as what they cut from above. A ball, bull, vee, drill or flat cutter is one
/// piece; each concave corner (step of a holder, rounding-over cutter) begins another one.
/// None if the outline has no width. Error: fewer than two points, a value that is not finite, a
/// negative radius, or heights that fall from one point to the next. O(points).
Result<std::vector<ConvexProfile>> convex_pieces(std::span<const ProfilePoint> outline);

/// What lies below height_mm above the tip; empty if nothing does.
ConvexProfile below(const ConvexProfile& piece, double height_mm);

/// Without the points that may go so that the rest stays within tolerance_mm of it. Chords lie
/// inside of the solid, so it only gets smaller.
ConvexProfile simplified(const ConvexProfile& piece, double tolerance_mm);

}  // namespace kerf
