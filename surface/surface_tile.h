// surface/surface_tile.h - the surface over one tile of a height grid, ready for rays.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "surface/height_grid.h"
#include "surface/wall_shift.h"

namespace kerf {

/// A TileRelief of level 0, and so the same surface as the workpiece's patches show. A cell's top
/// is two triangles:
///
///      d---c       d---c     Of the two diagonals that of has_rising_diagonal().
///      |  /|  or   |\  |
///      | / |       | \ |
///      a---b       a---b
///
struct SurfaceTile {
  static constexpr int kCells = HeightGrid::kTileCells;
  static constexpr int kBlockCells = 8;  ///< of a square that rays skip at once
  static constexpr int kBlocks = kCells / kBlockCells;

  /// Corners of a cell's top in the order a, b, c, d, where they are not those of its neighbours.
  struct SplitCell {
    std::array<float, 4> z;
    std::array<std::uint32_t, 4> normal;
    std::array<glm::vec2, 4> shift;  ///< in cells
    bool is_moved;                   ///< one of them is; then the cell need not be solid
  };
  struct Detail {
    /// By corner, of those where all four cells hang together; row by row.
    std::array<float, (kCells + 1) * (kCells + 1)> z;
    std::array<std::uint32_t, (kCells + 1) * (kCells + 1)> normal;  ///< packed (pack_normal)
    /// By cell, row by row: bit 0 solid, bit 1 diagonal a-c, above them 1 + index into `splits` or
    /// 0.
    std::array<std::uint16_t, kCells * kCells> code;
    std::vector<SplitCell> splits;
  };

  /// No less than any height of the surface over the tile and over each block; kNothing without
  /// material.
  float top = kNothing;
  std::array<float, kBlocks * kBlocks> block_top;
  /// None where the tile is level all over, at `top`, or has no material.
  std::unique_ptr<const Detail> detail;

  static constexpr float kNothing = -1e30f;
};

/// A cell's top: corner heights and which diagonal.
struct CellTop {
  float a, b, c, d;
  bool is_solid;
  bool is_rising;  ///< diagonal a-c
  /// Where corners are moved, else null: the top is not over the cell's square then, and those of
  /// the cells about it may reach into that.
  const SurfaceTile::SplitCell* moved = nullptr;
};

inline CellTop cell_top(const SurfaceTile::Detail& detail, int x, int y) {
  const unsigned code = detail.code[static_cast<std::size_t>(y * SurfaceTile::kCells + x)];
  const bool is_solid = (code & 1u) != 0, is_rising = (code & 2u) != 0;
  if (const unsigned split = code >> 2; split != 0) {
    const SurfaceTile::SplitCell& at = detail.splits[split - 1];
    const std::array<float, 4>& z = at.z;
    return {z[0], z[1], z[2], z[3], is_solid, is_rising, at.is_moved ? &at : nullptr};
  }
  const float* const low =
      detail.z.data() + static_cast<std::size_t>(y * (SurfaceTile::kCells + 1) + x);
  const float* const high = low + SurfaceTile::kCells + 1;
  return {low[0], low[1], high[1], high[0], is_solid, is_rising};
}

/// O(cells), some tens of microseconds; much less for a level tile.
SurfaceTile make_surface_tile(const HeightGrid& grid, int tx, int ty);

/// Cells beyond a cell up to which its change can change the surface or how it is lit: corners so
/// far away, and the cells about them reach a part of a cell farther.
inline constexpr int kSurfaceReach = WallShift::kMaxReach + 1;

}  // namespace kerf
