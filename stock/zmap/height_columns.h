// stock/zmap/height_columns.h - heights and the gaps below them as columns.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "stock/column_runs.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// A skin on the floor, or material between gaps, that is thinner holds nothing.
inline constexpr float kThinnestRun_mm = 0.01f;

inline ColumnLayout column_layout_of(const TileGrid& grid) {
  return {Vec2(grid.bounds_mm().min),
          {grid.cell_x_mm(), grid.cell_y_mm()},
          {grid.tiles_x(), grid.tiles_y(), 1},
          {kTileCells, kTileCells},
          static_cast<double>(kThinnestRun_mm)};
}

/// `see_gaps(offset, see)` calls see(low, high) for each gap of a cell, from above downward.
template <class SeeGaps>
void read_height_columns(const TileGrid& grid, std::uint32_t tile, const SeeGaps& see_gaps,
                         ColumnRuns& out) {
  const int tx = static_cast<int>(tile) % grid.tiles_x(),
            ty = static_cast<int>(tile) / grid.tiles_x();
  out.nx = std::min(kTileCells, grid.nx() - tx * kTileCells);
  out.ny = std::min(kTileCells, grid.ny() - ty * kTileCells);
  out.runs.clear();
  out.first.clear();
  const float* const heights = grid.tile(tile);
  const float floor = grid.floor_mm();
  for (int j = 0; j < out.ny; ++j) {
    for (int i = 0; i < out.nx; ++i) {
      const std::size_t begin = out.runs.size(), cell = TileGrid::offset(i, j);
      out.first.push_back(static_cast<std::uint32_t>(begin));
      float top = heights[cell];
      const auto add = [&](float low) {
        if (top - low > kThinnestRun_mm) out.runs.push_back({low, top});
      };
      see_gaps(cell, [&](float low, float high) {
        add(high);
        top = low;
      });
      add(floor);
      std::reverse(out.runs.begin() + static_cast<std::ptrdiff_t>(begin), out.runs.end());
    }
  }
  out.first.push_back(static_cast<std::uint32_t>(out.runs.size()));
}

}  // namespace kerf
