// stock/sheet/punch_hits.h - strokes of a punch: what they take out of a sheet, and what they meet.
//
// A stroke is a CutMove of a cutter with a footprint. It does not travel: the punch comes down at
// to_mm, turned about its own axis by the sweep of an arc round that place.
//
//          .-----.          from_mm = to_mm = center_mm
//         /   +   \  ) sweep_rad
//         '-------'
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/result.h"
#include "stock/plane/outline.h"
#include "stock/sheet/kerf_contour.h"
#include "stock/stock_model.h"

namespace kerf {

/// A punch of this shape (parse_punch_shape()); `spec` names it and tells it from others. Error:
/// from check_outline().
Result<Cutter> punch_cutter(std::string spec, const PlaneOutline& shape);

/// One stroke. `turn_rad` is counter-clockwise, seen from above.
CutMove punch_stroke(const Vec3& place_mm, double turn_rad, std::uint64_t id);
/// Of punch_stroke().
double turn_of(const CutMove& stroke);

/// Corners of the punch in the sheet where it comes down.
PlaneOutline footprint_at(const Cutter& punch, const CutMove& stroke);
/// What two shapes of footprint_at() - or a shape and a rectangle - have in common. O(n log n).
double overlap_mm2(const PlaneOutline& a, const PlaneOutline& b);
/// Even-odd.
double area_mm2(const PlaneOutline& shape);

namespace sheet {

/// Strokes that go into one polygon operation at most: beyond, what each of them costs grows.
inline constexpr std::size_t kMostStrokes = 64;

/// What these strokes take out together, for one polygon operation a tile. Strokes whose numbers
/// are not finite, or beyond 1e13 mm, take nothing.
Kerf kerf_of_strokes(const Cutter& punch, std::span<const CutMove> strokes);

}  // namespace sheet
}  // namespace kerf
