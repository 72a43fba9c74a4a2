// stock/sheet/polygon.h - what the sheet is made of: plane polygons in tenths of a micrometre.
#pragma once

#include <cstdint>
#include <vector>

#include "base/geometry.h"
#include "stock/plane/polygon.h"

namespace kerf::sheet {

using plane::bounds_of;
using plane::locate;
using plane::Point;
using plane::Rect;
using plane::Ring;
using plane::Rings;
using plane::shorten_beyond;
using plane::Side;
using plane::turn;
using plane::twice_area;
using plane::twice_area_of;
using plane::Unit;
using plane::winding_number;

/// One unit is 0.1 um: ten times finer than any drawing, and so coarse that 100 m (what a blank may
/// span) stays below 2^30 units, where the clipping library computes with 64 bits.
inline constexpr double kUnitsPerMm = 1e4;
inline constexpr double kMaxCoordinate_mm = 1e5;
/// What a sheet may be.
inline constexpr double kMinThickness_mm = 0.001, kMaxThickness_mm = 1000;
inline constexpr double kMinTolerance_mm = 0.0001, kMaxTolerance_mm = 1;

/// Half a unit and more is rounded away from zero, so mirrored drawings stay mirrored. The caller
/// keeps |mm| below 1e13.
Unit to_units(double mm);
Point to_units(const Vec2& mm);
inline double to_mm(Unit units) { return static_cast<double>(units) / kUnitsPerMm; }
inline Vec2 to_mm(const Point& p) { return {to_mm(p.X), to_mm(p.Y)}; }
inline double width_mm(const Rect& rect) { return to_mm(rect.max_x - rect.min_x); }
inline double height_mm(const Rect& rect) { return to_mm(rect.max_y - rect.min_y); }
/// Closed chains; corners that fall together are one.
Rings to_rings(const std::vector<std::vector<Vec2>>& chains_mm);
/// Of twice an area in square units.
double twice_area_to_mm2(std::int64_t twice_area);

}  // namespace kerf::sheet
