// stock/zmap/blank_grid.h - a blank as heights.
#pragma once

#include <string>

#include "base/result.h"
#include "stock/blank.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// The bodies of `blank` in cells of at most `cell_mm`. Error if cell_mm is not finite or <= 0,
/// exceeds the blank, or makes more than `most_cells` cells (then the message says how much memory
/// the heights would take), or if a body cannot be held (cylinder along x or y, floors at different
/// heights); it calls the model `model`, "a Z-map".
Result<TileGrid> make_blank_grid(const Blank& blank, double cell_mm, std::size_t most_cells,
                                 const std::string& model);

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
