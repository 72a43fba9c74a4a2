// stock/zmap/blank_grid.h - a blank as heights.
#pragma once

#include <algorithm>
#include <string>

#include "base/result.h"
#include "mesh/mesh_body.h"
#include "mesh/mesh_lines.h"
#include "stock/blank.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// The bodies of `blank`, or the top of what its mesh encloses, in cells of at most `cell_mm`.
/// Error if cell_mm is not finite or <= 0, exceeds the blank, or makes more than `most_cells` cells
/// (then the message says how much memory the heights would take), or if a body cannot be held
/// (cylinder along x or y, floors at different heights); it calls the model `model`, "a Z-map".
/// `keeps_cut_ids`: TileGrid::keep_cut_ids().
Result<TileGrid> make_blank_grid(const Blank& blank, double cell_mm, std::size_t most_cells,
                                 const std::string& model, bool keeps_cut_ids);

/// The cells of a grid seen from above.
ColumnGrid columns_of(const TileGrid& grid);

/// Calls take(first_row, band, lines) for rows of cells from low y on, some at a time: lines along
/// Z through their middles. Their memory stays small.
template <class Take>
void each_mesh_band(const MeshBody& body, const TileGrid& grid, const Take& take) {
  constexpr int kBandRows = 512;
  for (int first = 0; first < grid.ny(); first += kBandRows) {
    ColumnGrid band = columns_of(grid);
    band.ny = std::min(kBandRows, grid.ny() - first);
    band.bounds_mm.min.y += first * grid.cell_y_mm();
    band.bounds_mm.max.y = band.bounds_mm.min.y + band.ny * grid.cell_y_mm();
    take(first, band, MeshLines(body.mesh, 2, band));
  }
}

/// Of the material from the floor to the heights, mm3.
double volume_of(const TileGrid& grid);

/// 128 bits over the frame and the heights.
struct GridHash {
  std::uint64_t high = 0, low = 0;
  /// 32 hex digits.
  std::string text() const;
};
GridHash hash_of(const TileGrid& grid);

}  // namespace kerf
