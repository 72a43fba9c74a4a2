#include "stock/zmap/tile_cut_ids.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/mesh_patch.h"

namespace kerf {
namespace {

/// TileGrid::offset() in two parts, which are added.
struct Offsets {
  std::array<std::uint16_t, kTileCells> x{}, y{};
};
constexpr Offsets kOffsets = [] {
  Offsets offsets;
  for (int i = 0; i < kTileCells; ++i) {
    const auto at = static_cast<std::size_t>(i);
    offsets.x[at] = static_cast<std::uint16_t>(i / kBlockX * kBlockFloats + i % kBlockX);
    offsets.y[at] = static_cast<std::uint16_t>(i / kBlockY * kTileBlocksX * kBlockFloats +
                                               i % kBlockY * kBlockX);
  }
  return offsets;
}();

/// Where in a tile the lowest cell of [x0, x1) x [y0, y1) is; not empty.
std::size_t offset_of_lowest(const float* heights, int x0, int y0, int x1, int y1) {
  float lowest = std::numeric_limits<float>::infinity();
  std::size_t found = static_cast<std::size_t>(kOffsets.x[static_cast<std::size_t>(x0)]) +
                      kOffsets.y[static_cast<std::size_t>(y0)];
  for (int y = y0; y < y1; ++y) {
    const std::size_t row = kOffsets.y[static_cast<std::size_t>(y)];
    for (int x = x0; x < x1; ++x) {
      const std::size_t at = row + kOffsets.x[static_cast<std::size_t>(x)];
      const bool is_lower = heights[at] < lowest;
      lowest = is_lower ? heights[at] : lowest;
      found = is_lower ? at : found;
    }
  }
  return found;
}

/// The same for whole blocks, eight cells at a time: each looks for the lowest cell among those
/// that have its place in their blocks.
std::size_t offset_of_lowest_in_blocks(const float* heights, int x0, int y0, int span) {
  std::array<float, kBlockFloats> lowest;
  std::array<std::int32_t, kBlockFloats> found{};
  lowest.fill(std::numeric_limits<float>::infinity());
  for (int y = y0; y < y0 + span; y += kBlockY) {
    const std::int32_t row = kOffsets.y[static_cast<std::size_t>(y)];
    for (int x = x0; x < x0 + span; x += kBlockX) {
      const std::int32_t block = row + kOffsets.x[static_cast<std::size_t>(x)];
      for (std::size_t k = 0; k < kBlockFloats; ++k) {
        const float height = heights[static_cast<std::size_t>(block) + k];
        const bool is_lower = height < lowest[k];
        lowest[k] = is_lower ? height : lowest[k];
        found[k] = is_lower ? block : found[k];
      }
    }
  }
  const auto y_of = [&](std::size_t k) {
    return found[k] / (kTileBlocksX * kBlockFloats) * kBlockY + static_cast<int>(k) / kBlockX;
  };
  std::size_t first = 0;
  for (std::size_t k = 1; k < kBlockFloats; ++k) {
    if (lowest[k] > lowest[first]) continue;
    const int y = y_of(k), first_y = y_of(first);
    // Of equals in one row, the one in an earlier block or the left one of a block.
    if (lowest[k] < lowest[first] || y < first_y || (y == first_y && found[k] < found[first])) {
      first = k;
    }
  }
  return static_cast<std::size_t>(found[first]) + first;
}

/// Of the lowest cell in a square of `span` cells from (i, j), which lies in one tile, as much of
/// it as lies in the grid.
std::uint32_t id_of_lowest(const TileGrid& grid, int i, int j, int span) {
  if (i < 0 || j < 0 || i >= grid.nx() || j >= grid.ny()) return MeshPatch::kNotCut;
  const auto tile = static_cast<std::size_t>(j / kTileCells * grid.tiles_x() + i / kTileCells);
  const int x = i % kTileCells, y = j % kTileCells;
  const int width = std::min(span, grid.nx() - i), height = std::min(span, grid.ny() - j);
  const bool is_of_blocks = span % kBlockY == 0 && width == span && height == span;
  const float* const heights = grid.tile(tile);
  return grid.cut_ids(tile)[is_of_blocks ? offset_of_lowest_in_blocks(heights, x, y, span)
                                         : offset_of_lowest(heights, x, y, x + width, y + height)];
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
