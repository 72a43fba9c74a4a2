#include "stock/sheet/sheet_contact.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kerf::sheet {
namespace {

constexpr double kNever = 2;  // beyond every share

/// First t in 0 .. 1 with |a + t d - center| <= radius, given that it is farther at 0.
double meets_point(const Vec2& a, const Vec2& d, const Vec2& center, double radius) {
  const Vec2 arm = a - center;
  const double dd = glm::dot(d, d), ad = glm::dot(arm, d);
  const double root = ad * ad - dd * (glm::dot(arm, arm) - radius * radius);
  if (dd == 0 || ad >= 0 || root < 0) return kNever;
  const double t = (-ad - std::sqrt(root)) / dd;
  return t <= 1 ? t : kNever;
}

double distance_to(const Vec2& p, const Vec2& u, const Vec2& v) {
  const Vec2 edge = v - u;
  const double share = std::clamp(glm::dot(p - u, edge) / glm::dot(edge, edge), 0.0, 1.0);
  return glm::length(p - u - share * edge);
}

/// First t in 0 .. 1 at which a + t d is within `radius` of the edge from u to v.
double meets_edge(const Vec2& a, const Vec2& d, const Vec2& u, const Vec2& v, double radius) {
  if (distance_to(a, u, v) <= radius) return 0;
  double first = std::min(meets_point(a, d, u, radius), meets_point(a, d, v, radius));
  const Vec2 edge = v - u;
  const double length = glm::length(edge);
  const Vec2 normal(-edge.y / length, edge.x / length);
  const double from = glm::dot(a - u, normal), speed = glm::dot(d, normal);
  if (from * speed < 0) {
    const double t = (std::abs(from) - radius) / std::abs(speed);
    const double foot = glm::dot(a + t * d - u, edge);
    if (t >= 0 && t <= 1 && foot >= 0 && foot <= length * length) first = std::min(first, t);
  }
  return first;
}

double meets_tile(const Tile& tile, const Rect& box, const Vec2& a, const Vec2& d,
                  double radius_mm) {
  double first = kNever;
  for (const TileRingPointer& ring : tile.rings) {
    if (!ring->box.meets(box)) continue;
    Point u = ring->points.back();
    for (const Point& v : ring->points) {
      Rect edge;
      edge.extend(u);
      edge.extend(v);
      if (edge.meets(box)) first = std::min(first, meets_edge(a, d, to_mm(u), to_mm(v), radius_mm));
      u = v;
    }
  }
  return first;
}

}  // namespace

std::uint32_t piece_under(const SheetGrid& grid, const Point& p) {
  // A point on a border may be in material of either side.
  const Rect near{p.X - 1, p.Y - 1, p.X, p.Y};
  const SheetGrid::TileRange range = grid.tiles_meeting(near);
  for (int row = range.first_row; row <= range.last_row; ++row) {
    for (int column = range.first_column; column <= range.last_column; ++column) {
      const Tile& tile = grid.tile(grid.index_of(column, row));
      int depth = 0;
      // Of rings within rings the innermost outer one is the smallest.
      const TileRing* innermost = nullptr;
      std::uint32_t piece = kNoPiece;
      for (std::size_t i = 0; i < tile.rings.size(); ++i) {
        const TileRing& ring = *tile.rings[i];
        if (!ring.box.holds(p)) continue;
        const Side side = locate(p, ring.points);
        if (side == Side::kOutside) continue;
        if (side == Side::kBorder) return tile.pieces[ring.is_outer() ? i : owners(tile)[i]];
        depth += ring.is_outer() ? 1 : -1;
        if (!ring.is_outer() || (innermost && innermost->area2 <= ring.area2)) continue;
        innermost = &ring;
        piece = tile.pieces[i];
      }
      if (depth > 0) return piece;
    }
  }
  return kNoPiece;
}

bool holds_material(const SheetGrid& grid, const Point& p) {
  return piece_under(grid, p) != kNoPiece;
}

std::optional<double> first_meeting(const SheetGrid& grid, std::span<const Vec2> way_mm,
                                    double radius_mm) {
  if (holds_material(grid, to_units(way_mm[0]))) return 0.0;
  const auto chords = static_cast<double>(way_mm.size() - 1);
  for (std::size_t i = 1; i < way_mm.size(); ++i) {
    const Vec2 &a = way_mm[i - 1], &b = way_mm[i];
    Rect box;
    for (const Vec2& p : {a, b}) {
      box.extend(to_units(p - Vec2(radius_mm)));
      box.extend(to_units(p + Vec2(radius_mm)));
    }
    const SheetGrid::TileRange range = grid.tiles_meeting(box);
    double first = kNever;
    for (int row = range.first_row; row <= range.last_row; ++row) {
      for (int column = range.first_column; column <= range.last_column; ++column) {
        const Tile& tile = grid.tile(grid.index_of(column, row));
        first = std::min(first, meets_tile(tile, box, a, b - a, radius_mm));
      }
    }
    if (first <= 1) return (static_cast<double>(i - 1) + first) / chords;
  }
  return std::nullopt;
}

}  // namespace kerf::sheet
