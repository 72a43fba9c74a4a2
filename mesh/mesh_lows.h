// mesh/mesh_lows.h - how low the triangles of a body are over the cells of a grid.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh/column_lines.h"
#include "mesh/mesh_body.h"

namespace kerf {
namespace mesh_lows {

/// What only touches a cell's border has no share of it.
inline constexpr double kBorder_mm = 1e-6;

/// The least and the greatest x of a triangle between two heights of y; false: it is not there.
inline bool reach_between(const std::array<Vec3, 3>& p, double low_y, double high_y, double& left,
                          double& right) {
  left = std::numeric_limits<double>::infinity();
  right = -left;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = p[k], &b = p[(k + 1) % 3];
    double t0 = 0, t1 = 1;
    const double way = b.y - a.y;
    if (way == 0) {
      if (a.y < low_y || a.y > high_y) continue;
    } else {
      const double s = (low_y - a.y) / way, t = (high_y - a.y) / way;
      t0 = std::max(t0, std::min(s, t));
      t1 = std::min(t1, std::max(s, t));
      if (t0 > t1) continue;
    }
    for (const double t : {t0, t1}) {
      left = std::min(left, a.x + t * (b.x - a.x));
      right = std::max(right, a.x + t * (b.x - a.x));
    }
  }
  return left <= right;
}

}  // namespace mesh_lows

/// Calls take(cell, low_mm) for each cell that a triangle other than of the floor has more than its
/// border in: at `low_mm` its lowest point over the cell, or below.
template <class Take>
void each_low_over_cells(const MeshBody& body, const ColumnGrid& grid, const Take& take) {
  using mesh_lows::kBorder_mm;
  const Vec2 cell = grid.cell_mm(), low(grid.bounds_mm.min);
  const auto cells = [](double a, double b, double edge, int count) {
    const double first = std::floor((a + kBorder_mm) / edge);
    const double last = std::ceil((b - kBorder_mm) / edge) - 1;
    return std::pair(static_cast<int>(std::clamp<double>(first, 0, count)),
                     static_cast<int>(std::clamp<double>(last, -1, count - 1)));
  };
  for (const auto& triangle : body.mesh.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = Vec3(body.mesh.positions_mm[triangle[k]]);
    const double low_z = std::min({p[0].z, p[1].z, p[2].z});
    const double high_z = std::max({p[0].z, p[1].z, p[2].z});
    if (high_z <= body.box_mm.min.z) continue;
    const double turn =
        (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
    const Vec3 u = p[1] - p[0], v = p[2] - p[0];
    const bool leans = turn != 0;
    const double slope_x = leans ? (u.z * v.y - v.z * u.y) / turn : 0;
    const double slope_y = leans ? (v.z * u.x - u.z * v.x) / turn : 0;
    const double rise = 0.5 * (std::abs(slope_x) * cell.x + std::abs(slope_y) * cell.y);
    const double low_y = std::min({p[0].y, p[1].y, p[2].y});
    const double high_y = std::max({p[0].y, p[1].y, p[2].y});
    const auto [first_row, last_row] = cells(low_y - low.y, high_y - low.y, cell.y, grid.ny);
    for (int j = first_row; j <= last_row; ++j) {
      double left, right;
      const double from = low.y + j * cell.y;
      if (!mesh_lows::reach_between(p, from, from + cell.y, left, right)) continue;
      const auto [first, last] = cells(left - low.x, right - low.x, cell.x, grid.nx);
      const std::size_t row = static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.nx);
      for (int i = first; i <= last; ++i) {
        const Vec2 middle = grid.center(i, j);
        const double z =
            leans ? p[0].z + slope_x * (middle.x - p[0].x) + slope_y * (middle.y - p[0].y) - rise
                  : low_z;
        take(row + static_cast<std::size_t>(i), std::clamp(z, low_z, high_z));
      }
    }
  }
}

}  // namespace kerf
