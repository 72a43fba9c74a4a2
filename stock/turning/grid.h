// stock/turning/grid.h - the half plane in which turned parts are kept: z to the right, r up.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <span>

#include "base/geometry.h"
#include "stock/plane/polygon.h"

namespace kerf::turning {

using plane::Point;
using plane::Rect;
using plane::Ring;
using plane::Rings;
using plane::turn;
using plane::Unit;

/// One unit is 10 nm: whole steps of every program in mm or inches are whole units, and 2.6 m stay
/// below 2^28, so that turn() is below 2^59 and three of them add up in 64 bits.
inline constexpr double kUnitsPerMm = 1e5;
inline constexpr double kMaxCoordinate_mm = 2600;

/// Sums of area times height: exact for all that fits the grid.
__extension__ using Wide = __int128;

inline Unit to_units(double mm) { return std::llround(mm * kUnitsPerMm); }
/// X of the point is z.
inline Point to_units(const Vec2& zx_mm) { return {to_units(zx_mm.x), to_units(zx_mm.y)}; }
inline double to_mm(Unit units) { return static_cast<double>(units) / kUnitsPerMm; }
inline Vec2 to_mm(const Point& p) { return {to_mm(p.X), to_mm(p.Y)}; }

/// Of a place from an edge, or its end that is nearer.
inline double distance_to_edge_mm(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const double squared = glm::dot(way, way);
  const double share = squared > 0 ? std::clamp(glm::dot(p - a, way) / squared, 0.0, 1.0) : 0;
  return glm::distance(p, a + share * way);
}

/// Twice the area under an edge, seen from the origin, and six times its moment about the axis.
inline std::int64_t area2_of(const Point& p, const Point& q) {
  return static_cast<std::int64_t>(p.X * q.Y - q.X * p.Y);
}
inline Wide moment6_of(const Point& p, const Point& q) {
  return static_cast<Wide>(area2_of(p, q)) * (p.Y + q.Y);
}
/// Of a ring; sums on the way may wrap round and come back.
inline std::int64_t twice_area(std::span<const Point> ring) {
  std::uint64_t sum = 0;
  for (std::size_t i = 2; i < ring.size(); ++i)
    sum += static_cast<std::uint64_t>(turn(ring[0], ring[i - 1], ring[i]));
  return static_cast<std::int64_t>(sum);
}
/// What turns about the axis: 2 pi times the moment (Pappus).
inline double volume_mm3(Wide moment6) {
  return kPi / 3 * static_cast<double>(moment6) / (kUnitsPerMm * kUnitsPerMm * kUnitsPerMm);
}

}  // namespace kerf::turning
