// stock/zmap/mmap/wall_smoothing.h - oblique walls without stairs.
#pragma once

#include "base/triangle_mesh.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// Moves the corners of vertical walls in x and y, at most a quarter of a cell: all that stand
/// above each other together. For a mesh whose walls stand on the borders of the grid's cells.
///
///     ___                    A corner goes to the middle between itself and the middle of its two
///        |___      ___       neighbours along the wall, some times over. It stays where it is at
///            |__      ``-__  the side of the workpiece, where other than two walls meet, and
///                            where two runs of kLongRun cells or more meet.
void smooth_walls(const TileGrid& grid, TriangleMesh& mesh);

}  // namespace kerf
