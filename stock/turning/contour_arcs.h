// stock/turning/contour_arcs.h - contours of turned parts as lines and true arcs.
#pragma once

#include <optional>
#include <vector>

#include "stock/turning/contour.h"

namespace kerf::turning {

/// About `center_mm` by `sweep_rad`, counter-clockwise with z to the right and r up.
struct PieceArc {
  Vec2 center_mm{0};
  double radius_mm = 0;
  double sweep_rad = 0;
};

/// From one place (z, r) to another, mm: straight unless `arc` is set.
struct ContourPiece {
  Vec2 from_mm{0}, to_mm{0};
  std::optional<PieceArc> arc;
};

/// Closed: the last piece ends where the first begins. A whole circle is one piece.
using CurvedContour = std::vector<ContourPiece>;

/// The contour with an arc in place of each chain of kLeastArcEdges edges or more that keep within
/// kArcBand_mm of a circle, corners and middles. Contours are polygons whose corners stick out of
/// the arcs that they stand for so far that areas are equal (insert_sweep.h), so a circle's radius
/// is that of the mean of its edges: of a fifth of a turn and more it is good to 0.03 um. Where
/// pieces meet they are moved onto the arc, by no more than the band. What bends by less than
/// kLeastBend_mm stays a chain of lines, and so does what a program has cut in lines, unless they
/// are that short. O(n log n) as a rule.
CurvedContour with_arcs(const Contour& contour);

/// An arc of the outline may be off by 0.1 um, one of the way by 0.02 um more; rounding, and that
/// of the circle.
inline constexpr double kArcBand_mm = 1.5e-4;
inline constexpr double kLeastBend_mm = 1e-3;
inline constexpr std::size_t kLeastArcEdges = 4;

}  // namespace kerf::turning
