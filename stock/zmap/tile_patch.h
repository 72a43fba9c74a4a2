// stock/zmap/tile_patch.h - the surface of one tile of a height grid, as triangles for a view.
#pragma once

#include "base/mesh_patch.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// Level `level` of tile `tile`, with MeshPatch::cut_by if the grid keeps it; `version` is left 0.
/// Corners of the mesh lie at the corners of the cells, at the mean height of those cells about
/// them that belong to one smooth surface; between cells that do not there is a vertical wall
/// (which they are: tile_relief.h). Corners of walls are moved in x and y to where the wall has its
/// course, by less than half a cell, all that stand above each other together (wall_shift()).
///
///        mean of these two --> o-----                     What the picture shows in section is a
///                      o------/   .  |                     slope with a wall after it.
///               -----/        .   .  |
///                  .     .    .   .  o--------o-----
///
/// Against the heights of that level:
///   - Above a cell the surface lies between the least and the greatest height of the nine cells
///     about it, counting only those that are linked to it about one of its corners.
///   - At its centre it misses the cell's height by no more than 1.5 x kSteepestSlope x cell (three
///     steps to one side; in flanks that are steeper 1.5 x the highest of those steps), and where
///     the cells lie in a plane, by rounding.
///   - A step between cells that are not linked is a wall in full, on the same side of the cells'
///     centres as their common edge. It is 0.1 cells from the true wall in the mean, see WallShift;
///     along x or y it stands exactly at the cells' edges.
/// Normals of walls are level and follow the course of the wall, too (WallCourse); so do, seen from
/// above, those of flanks steeper than kSteepestSlope. Along a flank with arcs of 20 cells and more
/// they are within 11 degrees of the true ones for 99 % of its area, however steep it is, see
/// tests/stock/patch_flanks_test.cpp.
/// Squares of 8 x 8, 16 x 16 .. cells that are level (and cut by one move) keep only the corners at
/// their rim.
///
/// Each wall belongs to the tile of the higher side, so no tile shows a wall above its own surface
/// whatever the level of its neighbour. Over all tiles at one level each edge is in two triangles,
/// once in each direction; in four where two pieces of material touch at one corner only. Skirts
/// end at the tile's border, below all cells that any level joins with those beside it, so there is
/// no gap between tiles of several levels.
MeshPatch make_tile_patch(const TileGrid& grid, std::uint32_t tile, int level);

/// A number for the versions of the tile and of its eight neighbours, on which alone its patches
/// depend.
std::uint64_t tile_patch_version(const TileGrid& grid, std::uint32_t tile);

}  // namespace kerf
