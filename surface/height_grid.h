// surface/height_grid.h - a workpiece as one height per cell, to be looked at.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "base/geometry.h"

namespace kerf {

/// When the surface between two neighbouring cells is smooth, else there is a wall. Whoever makes a
/// surface from heights goes by these, so that all of them show the same one:
///   - the heights differ by no more than kSmooth says (a slope: height over the cell's edge), or
///   - the surface goes on rising (falling) beyond one of the two, there at least
///     1 / kMostSteepening as fast, and either the step is no more than kSteepest says, or the
///     surface goes on beyond both, there steeper than kFlank.
/// So the foot of a flank and its top edge are sharp, and all that lies between them is alike,
/// however steep. A cell with material and one without are never one surface.
struct SurfaceSlopes {
  static constexpr float kSmooth = 0.25f;   ///< about 14 degrees
  static constexpr float kSteepest = 6.0f;  ///< about 80 degrees
  static constexpr float kMostSteepening = 2.5f;
  /// 45 degrees: what is less steep on one side of a high step is its foot or its top edge.
  static constexpr float kFlank = 1.0f;

  /// `step`: the way up from one cell to the next; `before`, `after`: of the steps before and after
  /// it; 0 where a cell has no material. `edge`: of a cell. Does not branch, so that compilers ask
  /// about several at a time.
  static bool is_smooth(float step, float before, float after, float edge) {
    const float size = std::abs(step), with_before = step * before, with_after = step * after;
    const float most = with_before > with_after ? with_before : with_after;
    const float least = with_before < with_after ? with_before : with_after;
    return (size <= kSmooth * edge) |
           ((size * size <= kMostSteepening * most) &
            ((size <= kSteepest * edge) | (least >= kFlank * edge * size)));
  }
};

/// Heights of nx x ny cells in tiles, as a snapshot of a workpiece has them. Holds no heights of
/// its own: it points to the snapshot's, and keeps them. Immutable, so it may cross threads.
///
///      j                      Each tile has kTileCells x kTileCells floats. Inside it cells lie
///    ny +-------+---+         in blocks of kBlockX x kBlockY, blocks row by row, cells of a
///       | 2     | 3 |         block row by row (offset()). Tiles at the far ends may be partly
///       +-------+---+         outside; what is there must not be read.
///       | 0     | 1 |
///       +-------+---+  i      A cell at the floor holds no material; above the floor it is solid
///                  nx         from the floor up to its height.
///
/// As long as two grids live, equal pointers of a tile mean equal heights: models copy a tile
/// before they change one that a grid points to. That is how a view finds out what has changed.
///
/// Readers take a tile's pointer once and then read floats, without a call for each cell. A model
/// with several solid intervals in a cell gives its tiles in the same way.
class HeightGrid {
 public:
  static constexpr int kTileCells = 64;
  static constexpr int kBlockX = 2;
  static constexpr int kBlockY = 4;

  /// `bounds_mm`: from the floor to the top of the blank. `tiles`: row by row from low x, y, as
  /// many as cover the cells; they and what they point to are good as long as `keeper` lives.
  HeightGrid(const Box& bounds_mm, int nx, int ny, const float* const* tiles,
             std::shared_ptr<const void> keeper)
      : bounds_mm_(bounds_mm),
        nx_(nx),
        ny_(ny),
        tiles_x_((nx + kTileCells - 1) / kTileCells),
        cell_x_mm_(bounds_mm.size().x / nx),
        cell_y_mm_(bounds_mm.size().y / ny),
        tiles_(tiles),
        keeper_(std::move(keeper)) {}

  const Box& bounds_mm() const { return bounds_mm_; }
  int nx() const { return nx_; }
  int ny() const { return ny_; }
  double cell_x_mm() const { return cell_x_mm_; }
  double cell_y_mm() const { return cell_y_mm_; }
  float floor_mm() const { return static_cast<float>(bounds_mm_.min.z); }

  int tiles_x() const { return tiles_x_; }
  int tiles_y() const { return (ny_ + kTileCells - 1) / kTileCells; }
  const float* tile(int tx, int ty) const {
    return tiles_[static_cast<std::size_t>(ty) * static_cast<std::size_t>(tiles_x_) +
                  static_cast<std::size_t>(tx)];
  }
  bool contains(int i, int j) const { return i >= 0 && j >= 0 && i < nx_ && j < ny_; }
  /// Of a cell that the grid contains; never below the floor.
  float height(int i, int j) const {
    const auto x = static_cast<unsigned>(i), y = static_cast<unsigned>(j);
    const std::size_t row = y / kTileCells * static_cast<std::size_t>(tiles_x_);
    return std::max(floor_mm(), tiles_[row + x / kTileCells][offset(i, j)]);
  }

  /// A row of cells, whose share of what says where a cell lies is worked out once.
  class Row {
   public:
    Row(const HeightGrid& grid, int j)
        : tiles_(&grid.tiles_[static_cast<std::size_t>(j / kTileCells * grid.tiles_x_)]),
          first_(offset(0, j)) {}
    /// As it is kept: of a cell without material it may be below the floor.
    float kept(int i) const {
      const auto x = static_cast<unsigned>(i);
      return tiles_[x / kTileCells]
                   [first_ + x % kTileCells / kBlockX * (kBlockX * kBlockY) + x % kBlockX];
    }

   private:
    const float* const* tiles_;
    std::size_t first_;
  };

  /// Of (i, j), (i + 1, j), (i, j + 1) and (i + 1, j + 1), all of which the grid contains.
  std::array<float, 4> heights_of_four(int i, int j) const {
    const auto x = static_cast<unsigned>(i), y = static_cast<unsigned>(j);
    const auto row = static_cast<std::size_t>(tiles_x_);
    const float* const* const lower = tiles_ + y / kTileCells * row;
    const float* const* const upper = tiles_ + (y + 1) / kTileCells * row;
    const std::size_t left = x / kTileCells, right = (x + 1) / kTileCells;
    const float floor = floor_mm();
    return {std::max(floor, lower[left][offset_of_row(y) + offset_in_row(x)]),
            std::max(floor, lower[right][offset_of_row(y) + offset_in_row(x + 1)]),
            std::max(floor, upper[left][offset_of_row(y + 1) + offset_in_row(x)]),
            std::max(floor, upper[right][offset_of_row(y + 1) + offset_in_row(x + 1)])};
  }

  /// As they are kept, of the cell, which the grid contains, and of those about it, row by row from
  /// (i - 1, j - 1); past the grid's end its last one again.
  std::array<float, 9> kept_about(int i, int j) const {
    std::size_t tile_of[3], at[3];
    for (int n = 0; n < 3; ++n) {
      const auto x = static_cast<unsigned>(std::clamp(i + n - 1, 0, nx_ - 1));
      tile_of[n] = x / kTileCells, at[n] = offset_in_row(x);
    }
    std::array<float, 9> kept;
    for (int n = 0; n < 3; ++n) {
      const auto y = static_cast<unsigned>(std::clamp(j + n - 1, 0, ny_ - 1));
      const float* const* const row = tiles_ + y / kTileCells * static_cast<std::size_t>(tiles_x_);
      const std::size_t first = offset_of_row(y);
      for (int m = 0; m < 3; ++m)
        kept[static_cast<std::size_t>(3 * n + m)] = row[tile_of[m]][first + at[m]];
    }
    return kept;
  }

  /// Position of cell (i, j) within its tile.
  static std::size_t offset(int i, int j) {
    return offset_of_row(static_cast<unsigned>(j)) + offset_in_row(static_cast<unsigned>(i));
  }

 private:
  static std::size_t offset_of_row(unsigned j) {
    constexpr unsigned kFloats = kBlockX * kBlockY, kPerRow = kTileCells / kBlockX;
    const unsigned y = j % kTileCells;
    return y / kBlockY * (kPerRow * kFloats) + y % kBlockY * kBlockX;
  }
  static std::size_t offset_in_row(unsigned i) {
    const unsigned x = i % kTileCells;
    return x / kBlockX * (kBlockX * kBlockY) + x % kBlockX;
  }
  Box bounds_mm_;
  int nx_, ny_, tiles_x_;
  double cell_x_mm_, cell_y_mm_;
  const float* const* tiles_;
  std::shared_ptr<const void> keeper_;
};

}  // namespace kerf
