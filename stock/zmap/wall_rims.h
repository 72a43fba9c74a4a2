// stock/zmap/wall_rims.h - where the upright sides of what a tool sweeps cross the lines through
// the middles of cells.
#pragma once

#include <span>
#include <vector>

#include "base/geometry.h"
#include "stock/zmap/sweep_ops.h"
#include "stock/zmap/tile_grid.h"
#include "stock/zmap/wall_marks.h"

namespace kerf {

/// Appends the marks that sweeps of a convex tool leave: those whose foot is below what the heights
/// have beyond the wall, after these sweeps. Closed forms, in double precision and by operations
/// that round alike everywhere, so a mark does not depend on what else is swept. About 4 ns for
/// each line of cells that a side crosses; nothing for a tool whose side stays above the blank, or
/// that is thinner than a cell.
void find_wall_marks(const TileGrid& grid, const ConvexTool& tool, std::span<const SweepOp> ops,
                     std::vector<PlacedMark>& out);

/// How high a tool's tip may be for its upright sides to begin within the blank.
double highest_wall_tip_mm(const TileGrid& grid, const ConvexTool& tool);
/// The lowest tip of a sweep.
double lowest_tip_mm(const SweepOp& op);

/// Of an upright round side of the blank about `center`: material is within (`is_bore`: beyond) it.
void find_side_marks(const TileGrid& grid, const Vec2& center, double radius_mm, bool is_bore,
                     std::vector<PlacedMark>& out);

}  // namespace kerf
