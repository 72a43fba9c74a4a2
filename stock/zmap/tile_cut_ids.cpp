#include "stock/zmap/tile_cut_ids.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/mesh_patch.h"

namespace kerf {
namespace {

/// Of the lowest cell in a square of them, as much of it as lies in the grid.
std::uint32_t id_of_lowest(const TileGrid& grid, int i0, int j0, int span) {
  const bool begins_inside = i0 >= 0 && j0 >= 0 && i0 < grid.nx() && j0 < grid.ny();
  if (span == 1) return begins_inside ? grid.cut_id(i0, j0) : MeshPatch::kNotCut;
  std::uint32_t id = MeshPatch::kNotCut;
  float lowest = 0;
  bool first = true;
  for (int j = std::max(0, j0); j < std::min(grid.ny(), j0 + span); ++j) {
    for (int i = std::max(0, i0); i < std::min(grid.nx(), i0 + span); ++i) {
      const float height = grid.height(i, j);
      if (!first && height >= lowest) continue;
      first = false;
      lowest = height;
      id = grid.cut_id(i, j);
    }
  }
  return id;
}

}  // namespace

TileCutIds::TileCutIds(const TileGrid& grid, std::size_t tile, int level) {
  const int span = 1 << level, cells = kTileCells >> level;
  const int i0 = static_cast<int>(tile) % grid.tiles_x() * kTileCells;
  const int j0 = static_cast<int>(tile) / grid.tiles_x() * kTileCells;
  ids_.fill(MeshPatch::kNotCut);
  for (int j = -1; j <= cells; ++j) {
    for (int i = -1; i <= cells; ++i) {
      ids_[static_cast<std::size_t>(TileRelief::slot(i, j))] =
          id_of_lowest(grid, i0 + i * span, j0 + j * span, span);
    }
  }
}

std::uint32_t cut_id_at(const TileGrid& grid, const Vec3& point_mm) {
  const double x = (point_mm.x - grid.bounds_mm().min.x) / grid.cell_x_mm();
  const double y = (point_mm.y - grid.bounds_mm().min.y) / grid.cell_y_mm();
  const auto in_grid = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < grid.nx() && j < grid.ny();
  };
  const auto height = [&](int i, int j) {
    return in_grid(i, j) ? static_cast<double>(grid.height(i, j))
                         : -std::numeric_limits<double>::infinity();
  };
  const auto is_near = [](double at, int cell) {
    return at > cell - kWallReach && at < cell + 1 + kWallReach;
  };
  // Not only where the point is in a cell: a side of the blank may round to the outside.
  int i = std::clamp(static_cast<int>(std::floor(std::clamp(x, -1.0, 1e9))), 0, grid.nx() - 1);
  int j = std::clamp(static_cast<int>(std::floor(std::clamp(y, -1.0, 1e9))), 0, grid.ny() - 1);
  if (!is_near(x, i) || !is_near(y, j)) return MeshPatch::kNotCut;
  const double least_wall =
      static_cast<double>(TileRelief::kSmoothSlope) * std::min(grid.cell_x_mm(), grid.cell_y_mm());
  if (height(i, j) - point_mm.z > least_wall) {
    const int own_i = i, own_j = j;
    for (int v = own_j - 1; v <= own_j + 1; ++v) {
      for (int u = own_i - 1; u <= own_i + 1; ++u) {
        const bool borders = is_near(x, u) && is_near(y, v) && height(u, v) <= point_mm.z;
        if (borders && height(u, v) < height(i, j)) {
          i = u;
          j = v;
        }
      }
    }
  }
  return in_grid(i, j) ? grid.cut_id(i, j) : MeshPatch::kNotCut;
}

}  // namespace kerf
