// stock/zmap/mmap/column_editor.h - takes intervals out of the columns of one tile.
#pragma once

#include <limits>
#include <vector>

#include "stock/zmap/mmap/gap_grid.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// A column is its height and, below it, its gaps. A tile of either grid is unshared and gets a new
/// version when the first of its columns changes. One thread at a time for each tile.
class ColumnEditor {
 public:
  static constexpr float kNoEnd = std::numeric_limits<float>::infinity();

  /// `column` is working memory.
  ColumnEditor(TileGrid& grid, GapGrid& gaps, std::size_t tile, std::vector<Gap>& column)
      : grid_(grid),
        gap_grid_(gaps),
        tile_(tile),
        floor_(grid.floor_mm()),
        heights_(grid.tile(tile)),
        gaps_(gaps.tile(tile)),
        column_(column) {}
  ~ColumnEditor() {
    if (own_gaps_ != nullptr) gap_grid_.drop_if_empty(tile_);
  }
  ColumnEditor(const ColumnEditor&) = delete;
  ColumnEditor& operator=(const ColumnEditor&) = delete;

  /// Takes low .. high from a cell (TileGrid::offset()); what is left above, below or between gaps
  /// and thinner than kThinnest_mm goes with it. Returns the height of the material removed, mm.
  float remove(std::size_t cell, float low, float high, std::uint32_t id) {
    low = low > floor_ ? low : floor_;
    if (low >= heights_[cell] || high <= low) return 0;
    if ((gaps_ == nullptr || !gaps_->has(cell)) && high >= heights_[cell] - kThinnest_mm) {
      const float gone = heights_[cell] - low;
      set_height(cell, low, id);
      return gone;
    }
    if (gaps_ != nullptr && is_hollow(cell, low, high)) return 0;
    return remove_inside(cell, low, high, id);
  }

 private:
  bool is_hollow(std::size_t cell, float low, float high) const {
    bool hollow = false;
    gaps_->each(cell, [&](const Gap& gap) { hollow |= gap.low <= low && gap.high >= high; });
    return hollow;
  }
  float remove_inside(std::size_t cell, float low, float high, std::uint32_t id);
  void set_height(std::size_t cell, float height, std::uint32_t id);
  void set_gaps(std::size_t cell, std::span<const Gap> gaps);

  TileGrid& grid_;
  GapGrid& gap_grid_;
  std::size_t tile_;
  float floor_;
  const float* heights_;
  const GapTile* gaps_;
  float* own_heights_ = nullptr;
  GapTile* own_gaps_ = nullptr;
  std::vector<Gap>& column_;
};

}  // namespace kerf
