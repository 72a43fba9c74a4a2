#include "stock/plane/polygon.h"

#include <algorithm>

namespace kerf::plane {
namespace {

unsigned sides_beyond(const Point& p, const Rect& rect) {
  return (p.X < rect.min_x ? 1u : 0u) | (p.X > rect.max_x ? 2u : 0u) |
         (p.Y < rect.min_y ? 4u : 0u) | (p.Y > rect.max_y ? 8u : 0u);
}

/// Sign of the turn for points however far apart: those of a cut may lie beyond the blank.
int turn_sign(const Point& a, const Point& b, const Point& c) {
  __extension__ using Wide = __int128;
  const Wide value =
      static_cast<Wide>(b.X - a.X) * (c.Y - a.Y) - static_cast<Wide>(b.Y - a.Y) * (c.X - a.X);
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

}  // namespace

void Rect::extend(const Point& p) {
  min_x = std::min(min_x, p.X);
  min_y = std::min(min_y, p.Y);
  max_x = std::max(max_x, p.X);
  max_y = std::max(max_y, p.Y);
}

void Rect::extend(const Rect& other) {
  min_x = std::min(min_x, other.min_x);
  min_y = std::min(min_y, other.min_y);
  max_x = std::max(max_x, other.max_x);
  max_y = std::max(max_y, other.max_y);
}

Rect bounds_of(const Ring& ring) {
  Rect box;
  for (const Point& p : ring) box.extend(p);
  return box;
}

std::int64_t twice_area(const Ring& ring) {
  if (ring.size() < 3) return 0;
  // Relative to a corner; sums on the way may pass 2^63 and come back, which unsigned numbers do.
  const Point origin = ring.front();
  std::uint64_t sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    sum += static_cast<std::uint64_t>(turn(origin, ring[i], ring[i + 1]));
  return static_cast<std::int64_t>(sum);
}

Side locate(const Point& p, const Ring& ring) {
  bool inside = false;
  Point a = ring.back();
  for (const Point& b : ring) {
    if ((a.Y > p.Y) != (b.Y > p.Y)) {
      const int side = turn_sign(a, b, p);
      if (side == 0) return Side::kBorder;
      if ((side > 0) == (b.Y > a.Y)) inside = !inside;
    } else if (a.Y == p.Y && b.Y == p.Y && std::min(a.X, b.X) <= p.X && p.X <= std::max(a.X, b.X)) {
      return Side::kBorder;
    } else if (b == p) {
      return Side::kBorder;
    }
    a = b;
  }
  return inside ? Side::kInside : Side::kOutside;
}

void shorten_beyond(const Ring& ring, const Rect& rect, Ring& shortened, Rect& edges) {
  shortened.clear();
  const std::size_t n = ring.size();
  unsigned kept = 0;  // the first corner stays: the last one's bridge ends there
  unsigned current = sides_beyond(ring[0], rect);
  for (std::size_t i = 0; i < n; ++i) {
    const Point& a = ring[i];
    const Point& b = ring[i + 1 == n ? 0 : i + 1];
    const unsigned next = sides_beyond(b, rect);
    if ((current & next) == 0) {
      edges.extend(
          Rect{std::max(std::min(a.X, b.X), rect.min_x), std::max(std::min(a.Y, b.Y), rect.min_y),
               std::min(std::max(a.X, b.X), rect.max_x), std::min(std::max(a.Y, b.Y), rect.max_y)});
    }
    // The edge that bridges a left-out corner stays beyond the side that all three are beyond.
    if ((kept & current & next) == 0) {
      shortened.push_back(a);
      kept = current;
    }
    current = next;
  }
}

int winding_number(const Rings& rings, const Point& p) {
  int winding = 0;
  for (const Ring& ring : rings) {
    if (ring.empty()) continue;
    Point a = ring.back();
    for (const Point& b : ring) {
      if (a.Y <= p.Y && b.Y > p.Y && turn_sign(a, b, p) > 0) ++winding;
      if (a.Y > p.Y && b.Y <= p.Y && turn_sign(a, b, p) < 0) --winding;
      a = b;
    }
  }
  return winding;
}

}  // namespace kerf::plane
