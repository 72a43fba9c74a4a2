// stock/zmap/tile_cut_ids.h - which move cut the cells of a tile, as a patch shows them.
#pragma once

#include <array>
#include <cstdint>

#include "stock/zmap/tile_grid.h"
#include "surface/tile_relief.h"

namespace kerf {

/// Number of the move that cut each cell of a tile last, and each cell next to the tile:
/// MeshPatch::kNotCut where none did, and beyond the grid.
class TileCutIds {
 public:
  /// For a grid that keeps them. A cell of level n has the number of the lowest of its 2^n x 2^n
  /// cells, whose height it shows too; among equals, of the first in y, then x.
  TileCutIds(const TileGrid& grid, std::size_t tile, int level);
  TileCutIds(const TileCutIds&) = delete;
  TileCutIds& operator=(const TileCutIds&) = delete;

  /// `cell` is a TileRelief::slot() of the tile or next to it.
  std::uint32_t of(int cell) const { return ids_[static_cast<std::size_t>(cell)]; }
  /// Of the cells about a corner (by quadrant) that are in the group, the lowest one's: as with
  /// walls and levels, and the same from either side of a border between tiles.
  template <class InGroup>
  std::uint32_t at_corner(const TileRelief& relief, int corner, const InGroup& in_group) const {
    const std::array<int, 4> cells = TileRelief::cells_about(corner);
    int lowest = -1;
    for (std::size_t q = 0; q < 4; ++q) {
      if (!in_group(q)) continue;
      if (lowest < 0 || relief.height(cells[q]) < relief.height(lowest)) lowest = cells[q];
    }
    return of(lowest);
  }
  std::uint32_t at_corner(const TileRelief& relief, int corner) const {
    return at_corner(relief, corner, [](std::size_t) { return true; });
  }

 private:
  std::array<std::uint32_t, TileRelief::kSlots> ids_;
};

/// In parts of a cell. Farther than walls of patches are from the borders of cells (WallShift), and
/// points picked in a picture from those.
inline constexpr double kWallReach = 0.49;
static_assert(kWallReach > WallShift::kMost);

/// Number of the move that made the surface at `point_mm`; MeshPatch::kNotCut where none did, and
/// beyond the grid. For a grid that keeps them.
///
/// A point that is lower than its cell by more than a smooth surface is (TileRelief), and within
/// kWallReach of a neighbour that is no higher than the point, lies on a wall: then the number is
/// that neighbour's, whose move made the wall. (A wall of a patch may stand on either side of the
/// border of the cells.) If there are several such neighbours, that of the lowest; beyond the grid
/// is the side of the blank.
std::uint32_t cut_id_at(const TileGrid& grid, const Vec3& point_mm);

}  // namespace kerf
