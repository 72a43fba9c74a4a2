// stock/plane/outline_arcs.h - outlines of chords as lines and true arcs, for drawings.
#pragma once

#include <optional>
#include <vector>

#include "stock/plane/outline.h"

namespace kerf::plane {

/// A corner of a contour, and the edge that begins there: straight, or an arc of at most half a
/// turn. `bulge` is the tangent of a quarter of the arc's angle, positive counter-clockwise, as DXF
/// has it.
///
///        .-'''-.
///       /       \        bulge = 2 height / chord: 1 for a half circle
///      +---------+
struct CurveCorner {
  Vec2 point_mm{0};
  double bulge = 0;
  /// Of an arc.
  double radius_mm(const Vec2& to_mm) const;
};

struct CurveCircle {
  Vec2 center_mm{0};
  double radius_mm = 0;
};

/// A closed contour: a circle, or else a chain of which the last corner is joined to the first.
struct Curve {
  std::optional<CurveCircle> circle;
  std::vector<CurveCorner> corners;
};

/// The rings of an outline, in order, with an arc in place of each chain of chords that lie on one:
/// five corners at least that are on a circle but for rounding, chords that leave it by no more
/// than those of arcs cut with `arc_tolerance_mm` do, and a bend that is more than rounding.
///
/// Polygons of arcs have the area of the arc (CirclePolygon), which gives its radius: that of a
/// full circle is good to the unit. What else there is on the way of an arc and is within the
/// tolerance - a lead-in that ends on it leaves a bump of some um - goes with it. Corners where an
/// arc ends are where it meets what follows. Nothing is off by more than twice the tolerance.
///
/// Chords and arcs alike: an outline that check_outline() would refuse once its arcs are chords
/// again comes back without arcs. `unit_mm` is the step that corners were rounded to. O(corners),
/// and what check_outline() takes.
std::vector<Curve> curves_of(const PlaneOutline& outline, double arc_tolerance_mm,
                             double unit_mm = kOutlineUnit_mm);

/// Curves as chords within `tolerance_mm`.
PlaneOutline chords_of(const std::vector<Curve>& curves, double tolerance_mm);

}  // namespace kerf::plane
