// twin/compare/design_walls.h - where on a grid of cells the walls of a design stand.
#pragma once

#include <span>
#include <vector>

#include "mesh/column_lines.h"
#include "twin/compare/design_part.h"
#include "twin/compare/tool_reach.h"

namespace kerf {

/// A design seen from above, for ToolReach.
struct DesignFromAbove {
  std::vector<float> whole_mm;   ///< of each cell's middle; -infinity: there is no design
  std::vector<float> top_mm;     ///< the same but for those for which `walls` stand
  std::vector<WallPoint> walls;  ///< so that walls are known better than to a cell
};

/// Cells finer than these by rows and columns; more than so many cells are looked at without.
inline constexpr int kFinePerCell = 4;
inline constexpr std::size_t kMostCellsWithWalls = std::size_t{8} << 20;

/// Walls are looked for along the rows and the columns of the grid's middles, in kFinePerCell steps
/// a cell, and their points laid a quarter to half a cell into the design: between two walls as far
/// apart as a tool is wide ToolReach then always finds a place for it, and of where a wall leaves
/// off what is told is an eighth of a cell on average in the tool's favour. Middles of cells that
/// are nearer to a wall than that are taken out of `top_mm`. Where the design is steep, but no
/// wall, heights are those a quarter of a cell away, in the tool's favour, too: in a slot as wide
/// as it is a ball would else hang on its own flanks. 4 bytes for each fine cell, some 5 ns.
DesignFromAbove design_from_above(const DesignPart& design, const ColumnGrid& grid);

/// The same from heights: `along_x`: kFinePerCell for each cell of a row, `along_y`: rows of them
/// for each row of cells.
DesignFromAbove with_walls(const ColumnGrid& grid, std::vector<float> middles,
                           std::span<const float> along_x, std::span<const float> along_y);

}  // namespace kerf
