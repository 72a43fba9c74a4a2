// mesh/column_lines.h - where the vertical lines through the cells of a grid meet
// triangles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/geometry.h"

namespace kerf {

/// Cells over which columns stand. Row by row from low x, y.
struct ColumnGrid {
  Box bounds_mm;
  int nx = 0, ny = 0;

  std::size_t size() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
  Vec2 cell_mm() const { return {bounds_mm.size().x / nx, bounds_mm.size().y / ny}; }
  Vec2 center(int i, int j) const {
    const Vec2 cell = cell_mm();
    return {bounds_mm.min.x + (i + 0.5) * cell.x, bounds_mm.min.y + (j + 0.5) * cell.y};
  }
};

/// Beside where they are all lines count by so little that it only tells where one meets an edge:
/// towards `x` and `y` (1 or -1), and by far more along the one than along the other (simulation of
/// simplicity, H. Edelsbrunner, E. Muecke, 1990).
struct LineNudge {
  int x = -1, y = 1;
  bool is_more_along_y = true;

  /// Whether a line that meets an edge of this way counts as left of it.
  bool is_left_of(double way_x, double way_y) const {
    const bool by_y = is_more_along_y ? way_x != 0 : way_y == 0;
    return by_y ? way_x * y > 0 : way_y * x < 0;
  }
};

/// An edge of a triangle seen from above, from the lesser end to the greater one whatever triangle
/// it is of.
struct ColumnEdge {
  double x, y, way_x, way_y;
  bool is_turned, is_left_if_met;

  ColumnEdge(const glm::vec3& a, const glm::vec3& b, const LineNudge& nudge) {
    is_turned = std::pair(b.x, b.y) < std::pair(a.x, a.y);
    const glm::vec3& from = is_turned ? b : a;
    const glm::vec3& to = is_turned ? a : b;
    x = static_cast<double>(from.x);
    y = static_cast<double>(from.y);
    way_x = static_cast<double>(to.x) - x;
    way_y = static_cast<double>(to.y) - y;
    is_left_if_met = nudge.is_left_of(way_x, way_y);
  }
  /// The point lies left of the way from a to b.
  bool has_left(double px, double py) const {
    const double side = way_x * (py - y) - way_y * (px - x);
    return (side != 0 ? side > 0 : is_left_if_met) != is_turned;
  }
};

/// Calls take(cell, z, up) for each line that meets the triangle: `up` is 1 where the triangle,
/// counter-clockwise, is seen from above, and -1 from below. A line through an edge or a corner of
/// triangles meets each surface once: it counts as a little beside where it is (`nudge`), by
/// products that come out the same for both triangles of an edge. So crossings are those of a
/// closed mesh, however it lies on the grid.
template <class Take>
void each_column_line(const std::array<glm::vec3, 3>& corners, const ColumnGrid& grid,
                      const Take& take, const LineNudge& nudge = {}) {
  const Vec3 a(corners[0]), b(corners[1]), c(corners[2]);
  const double turn = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (turn == 0) return;  // seen from its side: lines run along it or past it
  const Vec2 cell = grid.cell_mm();
  const auto [low_y, high_y] = std::minmax({a.y, b.y, c.y});
  const double min_y = grid.bounds_mm.min.y, min_x = grid.bounds_mm.min.x;
  const auto row_of = [&](double y) { return (y - min_y) / cell.y - 0.5; };
  const int first_row = static_cast<int>(std::clamp<double>(std::floor(row_of(low_y)), 0, grid.ny));
  const int last_row =
      static_cast<int>(std::clamp<double>(std::ceil(row_of(high_y)), -1, grid.ny - 1));
  const std::array<ColumnEdge, 3> edges{ColumnEdge(corners[0], corners[1], nudge),
                                        ColumnEdge(corners[1], corners[2], nudge),
                                        ColumnEdge(corners[2], corners[0], nudge)};
  const bool is_left_in = turn > 0;
  const double slope_x = ((b.z - a.z) * (c.y - a.y) - (c.z - a.z) * (b.y - a.y)) / turn;
  const double slope_y = ((c.z - a.z) * (b.x - a.x) - (b.z - a.z) * (c.x - a.x)) / turn;
  const auto [low_z, high_z] = std::minmax({a.z, b.z, c.z});
  const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
  const int up = is_left_in ? 1 : -1;
  for (int j = first_row; j <= last_row; ++j) {
    const double y = min_y + (j + 0.5) * cell.y;
    // Where the row crosses the triangle, and a cell more: the products decide.
    double left = high_x, right = low_x;
    for (const ColumnEdge& e : edges) {
      const double end = e.y + e.way_y;
      if (y < std::min(e.y, end) || y > std::max(e.y, end)) continue;
      if (e.way_y == 0) {
        left = std::min({left, e.x, e.x + e.way_x});
        right = std::max({right, e.x, e.x + e.way_x});
        continue;
      }
      const double x = e.x + e.way_x * ((y - e.y) / e.way_y);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (left > right) continue;
    const auto column_of = [&](double x) { return (x - min_x) / cell.x - 0.5; };
    const int first =
        static_cast<int>(std::clamp<double>(std::floor(column_of(left)) - 1, 0, grid.nx));
    const int last =
        static_cast<int>(std::clamp<double>(std::ceil(column_of(right)) + 1, -1, grid.nx - 1));
    const std::size_t row = static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.nx);
    for (int i = first; i <= last; ++i) {
      const double x = min_x + (i + 0.5) * cell.x;
      if (edges[0].has_left(x, y) != is_left_in || edges[1].has_left(x, y) != is_left_in ||
          edges[2].has_left(x, y) != is_left_in)
        continue;
      const double on_plane = a.z + slope_x * (x - a.x) + slope_y * (y - a.y);
      take(row + static_cast<std::size_t>(i),
           static_cast<float>(std::clamp(on_plane, low_z, high_z)), up);
    }
  }
}

}  // namespace kerf
