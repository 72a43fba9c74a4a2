// stock/plane/polygon.h - plane polygons on an integer grid, for models of any unit.
//
// A ring is a closed chain of corners, the last one joined to the first. Counter-clockwise rings
// bound material from outside, clockwise ones are holes in it:
//
//      +-------------+        A flat list of rings is a region if no two of them cross: the
//      |   .-<-.     |        material is where the rings wind once.
//      v   |   |     ^
//      |   `->-'     |
//      +------>------+
#pragma once

#include <cstdint>
#include <polyclipping/clipper.hpp>

namespace kerf::plane {

using Unit = ClipperLib::cInt;
using Point = ClipperLib::IntPoint;
using Ring = ClipperLib::Path;
using Rings = ClipperLib::Paths;

/// Closed on all sides; default-constructed it is empty.
struct Rect {
  Unit min_x = INT64_MAX, min_y = INT64_MAX, max_x = INT64_MIN, max_y = INT64_MIN;

  bool empty() const { return min_x > max_x; }
  void extend(const Point& p);
  void extend(const Rect& other);
  bool meets(const Rect& other) const {
    return min_x <= other.max_x && other.min_x <= max_x && min_y <= other.max_y &&
           other.min_y <= max_y;
  }
  bool holds(const Point& p) const {
    return p.X >= min_x && p.X <= max_x && p.Y >= min_y && p.Y <= max_y;
  }
};

Rect bounds_of(const Ring& ring);

/// Positive for counter-clockwise rings. Exact for rings that fit into 2^30 x 2^30 units.
std::int64_t twice_area(const Ring& ring);

/// Positive if c lies to the left of the line from a to b. Exact for points less than 2^31 units
/// apart.
inline std::int64_t turn(const Point& a, const Point& b, const Point& c) {
  return static_cast<std::int64_t>((b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X));
}

inline std::int64_t twice_area_of(const Rect& rect) {
  return 2 * static_cast<std::int64_t>(rect.max_x - rect.min_x) *
         static_cast<std::int64_t>(rect.max_y - rect.min_y);
}

enum class Side { kOutside, kInside, kBorder };
/// Exact. Whichever way the ring turns.
Side locate(const Point& p, const Ring& ring);

/// A chain of fewer corners that winds round every point of `rect` as `ring` does, and has the same
/// edges within it: chains of corners beyond one and the same side of it are shortened. Extends
/// `edges` by a box round the edges that may meet the rectangle, as far as within it.
void shorten_beyond(const Ring& ring, const Rect& rect, Ring& shortened, Rect& edges);

/// How often the rings wind round p, which lies on none of them.
int winding_number(const Rings& rings, const Point& p);

}  // namespace kerf::plane
