// stock/plane/outline_curves.h - curves of drawings as chains of points.
#pragma once

#include <vector>

#include "base/geometry.h"

namespace kerf::plane {

/// Points of an arc about `center` from angle `from_rad` on, by `sweep_rad` (counter-clockwise if
/// positive), without the first one. Chords are off by `tolerance_mm` at most, and so far out
/// between the ends - everywhere, of a full circle - that the arc keeps its area. `ratio`: the
/// circle squeezed to an ellipse with its second axis so much shorter, and turned by `turned_rad`.
void append_arc(const Vec2& center, double radius_mm, double from_rad, double sweep_rad,
                double tolerance_mm, std::vector<Vec2>& points, double ratio = 1,
                double turned_rad = 0);

/// From the last point to `to`: the tangent of a quarter of the arc's angle is `bulge` (positive:
/// counter-clockwise), as DXF has it.
void append_bulge(const Vec2& to, double bulge, double tolerance_mm, std::vector<Vec2>& points);

/// From the last point, cubic.
void append_bezier(const Vec2& control1, const Vec2& control2, const Vec2& to, double tolerance_mm,
                   std::vector<Vec2>& points);

}  // namespace kerf::plane
