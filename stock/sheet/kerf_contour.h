// stock/sheet/kerf_contour.h - the contour of what a torch takes away on one move.
//
//        .---------------------.          line: two sides and two half circles
//       (   *--------------*    )
//        `---------------------'
//
//            _.----._                     arc of radius R, kerf of radius r < R: outer side R + r,
//         .-'  _..._ `-.                  inner side R - r, two half circles; for a full circle a
//        /   .' .-. `.  \                 ring with a hole. Where the kerf is wider than the arc
//       ( * )  '   `( * )                 (r >= R) every disc covers the centre: outer side, then
//        `-'         `-'                  the end's circle and the start's up to where they meet.
#pragma once

#include <vector>

#include "stock/sheet/polygon.h"
#include "stock/stock_model.h"

namespace kerf::sheet {

/// Rings that wind round every point of the kerf at least once, and round no other.
struct Kerf {
  Rings rings;
  Rect box;
  /// They cross neither themselves nor each other, and wind round no point twice. If not, they may.
  bool plain = false;
};

/// Corners of regular polygons on the unit circle, kept for the next time. Not for several threads.
class CircleTables {
 public:
  /// `count` points at multiples of 360 / count degrees; count at most kMaxCount.
  const std::vector<Vec2>& points(int count);
  static constexpr int kMaxCount = 8192;

 private:
  std::vector<std::vector<Vec2>> tables_;
};

/// How a circle becomes a polygon. Corners lie at multiples of 2 pi / count from the x axis, so
/// arcs of one circle share them, and so far out that the polygon has the area of the circle:
/// what is off outward at the corners (two thirds of the sagitta) and inward between them (one
/// third) cancels.
struct CirclePolygon {
  int count = 0;         ///< a multiple of 4
  double corner_mm = 0;  ///< distance of the corners from the centre
  static CirclePolygon within(double radius_mm, double tolerance_mm);
};

/// What a disc of `radius_mm` sweeps on the move, seen from above: z plays no part, the spindle is
/// taken to be upright. The contour is off by at most `tolerance_mm` (and half a unit) anywhere.
/// Arcs about z: of any sweep, a full turn and more make a ring. Arcs whose radius changes by more
/// than an eighth of the tolerance, and arcs about other axes, become chains of straight pieces,
/// all of them rings of the one kerf. Empty if a number is not finite, or beyond 1e13 mm.
///
/// `tables` are only kept between calls. O(corners).
Kerf kerf_of_move(const CutMove& move, double radius_mm, double tolerance_mm, CircleTables& tables);

/// The tip's way from above, as chords within `tolerance_mm` of it: at least two points.
std::vector<Vec2> chords_of_move(const CutMove& move, double tolerance_mm);

}  // namespace kerf::sheet
