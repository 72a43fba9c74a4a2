// stock/zmap/tile_grid.h - heights in copy-on-write tiles.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "base/geometry.h"
#include "stock/zmap/sweep_ops.h"

namespace kerf {

/// nx x ny heights. Copying the grid is cheap: tiles are shared until one of the copies writes to
/// them. Cells that pad the last tiles hold a height below any floor and are never read by the
/// functions here.
class TileGrid {
 public:
  /// Every cell at the floor (no material).
  TileGrid(const Box& bounds_mm, int nx, int ny);
  TileGrid(const TileGrid&) = default;
  ~TileGrid();

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  int tiles_x() const { return tiles_x_; }
  int tiles_y() const { return tiles_y_; }
  const Box& bounds_mm() const { return bounds_; }
  double cell_x_mm() const { return bounds_.size().x / nx_; }
  double cell_y_mm() const { return bounds_.size().y / ny_; }
  float floor_mm() const { return static_cast<float>(bounds_.min.z); }

  float height(int i, int j) const { return tile(i / kTileCells, j / kTileCells)[offset(i, j)]; }
  const float* tile(int tx, int ty) const { return tiles_[index(tx, ty)].get(); }
  /// Heights of row j, x = 0..nx-1.
  void copy_row(int j, float* out) const;
  void set_row(int j, const float* in);

  /// Pointers for the kernels: null where a tile is shared. Valid until the grid is copied.
  std::vector<float*> writable_pointers();
  /// Own copy of a shared tile. Calls for different tiles may run at the same time.
  float* make_writable(int tile_index);

  /// Position of cell (i, j) within its tile.
  static std::size_t offset(int i, int j) {
    const int x = i % kTileCells, y = j % kTileCells;
    return static_cast<std::size_t>((y / kBlockY * kTileBlocksX + x / kBlockX) * kBlockFloats +
                                    y % kBlockY * kBlockX + x % kBlockX);
  }

 private:
  std::size_t index(int tx, int ty) const {
    return static_cast<std::size_t>(ty) * static_cast<std::size_t>(tiles_x_) +
           static_cast<std::size_t>(tx);
  }
  void meet_other_grids() const;
  Box bounds_;
  int nx_, ny_, tiles_x_, tiles_y_;
  std::vector<std::shared_ptr<float>> tiles_;
  std::shared_ptr<std::atomic<unsigned>> meetings_;  ///< one for all copies of a grid
};

}  // namespace kerf
