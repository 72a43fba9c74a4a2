// stock/sheet/sheet_border.h - the edges of the sheet's material, without those that only divide
// tiles.
#pragma once

#include <vector>

#include "stock/plane/outline.h"
#include "stock/sheet/sheet_grid.h"

namespace kerf::sheet {

/// A ring of a tile as neighbours see it: with their corners on the common border as well, so that
/// what is made of it fits to what is made of theirs.
struct FittedRing {
  Ring points;
  /// Of the edge that begins at each point: the sheet ends there. Otherwise the neighbour goes on.
  std::vector<char> is_edge;
};

/// In the order of the tile's rings.
std::vector<FittedRing> fit_to_neighbours(const SheetGrid& grid, std::size_t tile);

/// Closed rings round the material of one piece across all tiles: counter-clockwise outside,
/// clockwise round holes. Corners that are there only because a straight edge passes from one tile
/// into the next are left out. All pieces together if `piece` is kNoPiece. O(corners of the tiles
/// that hold some of it, times the logarithm).
Rings outline_of(const SheetGrid& grid, std::uint32_t piece);

}  // namespace kerf::sheet
