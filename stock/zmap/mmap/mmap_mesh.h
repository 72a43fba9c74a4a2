// stock/zmap/mmap/mmap_mesh.h - closed triangle mesh of columns with gaps.
#pragma once

#include <span>

#include "base/mesh_patch.h"
#include "base/triangle_mesh.h"
#include "stock/zmap/mmap/gap_grid.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// The surface of all patches of level 0, in one piece, heights to 1/4096 mm; walls where their
/// course is (wall_shift()). Differs from the patches in this: where pieces of material touch at an
/// edge or a point only, each has corners of its own, a hundredth of a cell inside.
/// Result: closed, every edge in exactly two triangles, once in each direction, normals outward;
/// no two edges in the same place. The volume differs from that of the columns by no more than half
/// a cell times the area of the walls, plus half the step between linked cells times the area of
/// the surfaces that are not level (in practice both cancel out but for some 0.1 %).
/// O(n log n) of the triangles.
TriangleMesh mesh_columns(const TileGrid& grid, const GapGrid& gaps);

/// The second half of it: a closed mesh whose edges are all in as many triangles in one direction
/// as in the other becomes a manifold. `inset_mm`: how far corners that meet are moved apart.
TriangleMesh separate_touching(TriangleMesh mesh, float inset_mm);

}  // namespace kerf
