// stock/zmap/tile_grid.h - heights in copy-on-write tiles.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/geometry.h"
#include "stock/zmap/sweep_ops.h"

namespace kerf {

class PackedTile;
class TileArena;

/// nx x ny heights, on request with the number of the move that lowered each cell last. Copying the
/// grid is cheap: tiles are shared until one of the copies writes to them. A tile has a version, a
/// new number with every change: for the copies of one grid, equal versions of a tile mean equal
/// heights (and numbers). Cells that pad the last tiles hold a height below any
/// floor and are never read by the functions here.
class TileGrid {
 public:
  /// Every cell at the floor (no material); with numbers, as keep_cut_ids() has them.
  TileGrid(const Box& bounds_mm, int nx, int ny, bool keeps_cut_ids = false);
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
  const float* tile(int tx, int ty) const { return cells_[index(tx, ty)]; }
  /// All tiles, row by row; good until the grid is changed or gone.
  const float* const* tiles() const { return cells_.data(); }
  /// From the floor to the top of the grid's bounds.
  Box tile_box(std::size_t tile_index) const;
  /// Whether there is a number for each cell. On: MeshPatch::kNotCut in all of them, in tiles twice
  /// as large. Copies made before stay as they are.
  void keep_cut_ids(bool keep);
  bool keeps_cut_ids() const { return keeps_cut_ids_; }
  /// Tiles that are equal share one memory from now on, as copies of the grid share theirs: most of
  /// a fresh blank's are. Finds those of a few kinds that lie side by side somewhere.
  void share_equal_tiles();
  /// Numbers of a tile's cells, in the order of its heights. Only where they are kept.
  const std::uint32_t* cut_ids(std::size_t tile_index) const {
    return cut_ids_of(cells_[tile_index]);
  }
  std::uint32_t cut_id(int i, int j) const {
    constexpr unsigned kSide = kTileCells;
    const std::size_t row = static_cast<unsigned>(j) / kSide * static_cast<std::size_t>(tiles_x_);
    return cut_ids(row + static_cast<unsigned>(i) / kSide)[offset(i, j)];
  }
  /// As PresentHeights has them: MeshPatch::kNotCut where none are kept.
  std::array<std::uint32_t, 4> cut_ids_of_four(int i, int j) const;
  void read_cut_ids(int i, int j, bool along_x, std::span<std::uint32_t> out) const;
  std::size_t tile_bytes() const { return (keeps_cut_ids_ ? 2 : 1) * kTileFloats * sizeof(float); }

  /// Heights of row j, x = 0..nx-1.
  void copy_row(int j, float* out) const;
  /// Of rows j to j + kBlockY - 1, as far as they are in the grid, one behind the other; `j`: of a
  /// block's first row. In less time than row by row.
  void copy_rows(int j, float* out) const;
  void set_row(int j, const float* in);
  /// The least height of cells x0 .. x1-1 of rows y0 .. y1-1, as far as they are in the grid, the
  /// floor at least; infinite if none is. Where the borders are those of blocks, 0.1 ns a cell.
  float lowest_mm(int x0, int y0, int x1, int y1) const;

  std::size_t tile_count() const { return tiles_.size(); }
  const float* tile(std::size_t tile_index) const { return cells_[tile_index]; }
  std::uint64_t version(std::size_t tile_index) const { return versions_[tile_index]; }
  /// Takes a change of version back where the heights have turned out to be the same.
  void restore_version(std::size_t tile_index, std::uint64_t version) {
    versions_[tile_index] = version;
  }

  /// To be called before a round of make_writable(): what is written until the next one counts as
  /// one change.
  void begin_change();
  /// Where tile `tile_index` may be written until the grid is copied or the next change begins:
  /// in a copy of its own if it is shared. Gives it the version of this change. Calls for
  /// different tiles may run at the same time.
  float* make_writable(std::size_t tile_index);
  /// Memory of the tiles that no other grid shares.
  std::size_t unique_bytes() const;

  /// As StockModel has them, for copies of one grid. No tile of a grid with packed ones may be
  /// looked at before it has been copied and the copy unpacked.
  static bool pack(std::span<TileGrid* const> copies, std::size_t at);
  std::size_t kept_bytes(const TileGrid& before, const TileGrid* after) const;
  void unpack();

  /// Position of cell (i, j) within its tile.
  static std::size_t offset(int i, int j) {
    const unsigned x = static_cast<unsigned>(i) % kTileCells;
    const unsigned y = static_cast<unsigned>(j) % kTileCells;
    return (y / kBlockY * kTileBlocksX + x / kBlockX) * kBlockFloats + y % kBlockY * kBlockX +
           x % kBlockX;
  }

 private:
  std::size_t index(int tx, int ty) const {
    return static_cast<std::size_t>(ty) * static_cast<std::size_t>(tiles_x_) +
           static_cast<std::size_t>(tx);
  }
  void meet_other_grids() const;
  void fill_part_of_tile(std::size_t tile_index);
  void set_tile(std::size_t tile_index, std::shared_ptr<float> tile) {
    cells_[tile_index] = tile.get();
    tiles_[tile_index] = std::move(tile);
  }
  /// Has the same memory of a tile as `other`, which has the same version of it.
  void share_with(const TileGrid& other, std::size_t tile);
  void set_packed(std::size_t tile, const std::shared_ptr<const PackedTile>& packed);
  Box bounds_;
  int nx_, ny_, tiles_x_, tiles_y_;
  bool keeps_cut_ids_ = false;
  std::shared_ptr<TileArena> arena_;  ///< one for all copies of a grid that keep the same
  std::vector<std::shared_ptr<float>> tiles_;
  std::vector<const float*> cells_;  ///< where they are: set_tile()
  /// Of tiles that are null above; empty: there are none.
  std::vector<std::shared_ptr<const PackedTile>> packed_;
  std::vector<std::uint64_t> versions_;
  std::uint64_t change_ = 0;
  std::shared_ptr<std::atomic<unsigned>> meetings_;  ///< one for all copies of a grid
};

}  // namespace kerf
