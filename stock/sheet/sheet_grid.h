// stock/sheet/sheet_grid.h - the sheet in copy-on-write tiles, and what is cut out of it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "stock/sheet/difference.h"
#include "stock/sheet/kerf_contour.h"
#include "stock/sheet/tile.h"

namespace kerf::sheet {

/// A tile as it was before a change.
struct TileChange {
  std::uint32_t tile = 0;
  TilePointer before;
  std::vector<std::uint32_t> gone;  ///< its rings that are not in the new tile
  std::uint32_t first_new = 0;      ///< of the new tile's rings; those before are old ones
};

/// columns x rows tiles over a rectangle, row by row from low x, y. Copying the grid copies one
/// pointer a tile; a changed tile is a new one. Each operation works tile by tile, so that its cost
/// is set by what is near.
class SheetGrid {
 public:
  /// `outline`: rings that wind once round the material, holes clockwise.
  SheetGrid(const Rings& outline, int columns, int rows);
  /// Without material: set_rings() gives each tile its own. At least one unit for each tile.
  SheetGrid(const Rect& bounds, int columns, int rows);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const Rect& bounds() const { return bounds_; }
  std::size_t tile_count() const { return tiles_.size(); }
  const Tile& tile(std::size_t index) const { return *tiles_[index]; }
  /// Is it another grid's as well?
  bool is_shared(std::size_t index) const { return tiles_[index].use_count() > 1; }
  Rect tile_rect(std::size_t index) const;
  /// Beyond `side` of the tile; -1 where the sheet ends.
  std::int64_t neighbour(std::size_t index, BorderSide side) const;
  /// By side.
  std::array<std::int64_t, 4> neighbours(std::size_t index) const;
  /// Tiles that the rectangle meets: columns and rows from first to last; empty if first > last.
  struct TileRange {
    int first_column, last_column, first_row, last_row;
  };
  TileRange tiles_meeting(const Rect& rect) const;
  std::size_t index_of(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  /// Takes the kerf away, with one polygon operation for each tile that its contour passes through,
  /// and appends the tiles that have become smaller. Outer rings of the new tiles have the piece of
  /// the ring that they were part of. Rings that the kerf does not come near take no part in the
  /// operation. Leaves no specks: what has less than kMinArea2 goes with the kerf.
  void subtract(const Kerf& kerf, std::vector<TileChange>& changes);

  /// Material of an empty tile: a region within it.
  void set_rings(std::size_t index, std::vector<Ring> rings);
  /// Tile::pieces, to be assigned; the tile keeps its version, which tells of its rings alone. Made
  /// this grid's own first where it is shared.
  std::vector<std::uint32_t>& pieces(std::size_t index);

  /// Twice the area of the material, in square units. Exact.
  std::int64_t area2() const { return area2_; }
  std::size_t corner_count() const;
  /// Polygon operations so far: for measurements.
  std::uint64_t operations() const { return operations_; }

  /// Twice one square micrometre: below what the grid of 0.1 um resolves as a shape.
  static constexpr std::int64_t kMinArea2 = 200;
  static constexpr int kMaxTilesEachWay = 65536;

 private:
  void subtract_from_tile(std::size_t index, const Rings& kerf, bool plain,
                          std::vector<TileChange>& changes);
  void subtract_by_library();
  void replace(std::size_t index, Tile tile, TileChange change, std::vector<TileChange>& changes);

  Rect bounds_;
  int columns_ = 1, rows_ = 1;
  std::vector<std::shared_ptr<Tile>> tiles_;
  std::int64_t area2_ = 0;
  std::uint64_t operations_ = 0;
  // Kept for their memory:
  Rings row_rings_, shortened_, result_;
  std::vector<const Ring*> subject_;
  std::vector<std::uint32_t> subject_rings_;
  Difference difference_;
};

}  // namespace kerf::sheet
