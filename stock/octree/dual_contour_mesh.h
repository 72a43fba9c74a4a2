// stock/octree/dual_contour_mesh.h - the whole surface of a field as one closed mesh.
#pragma once

#include <array>
#include <span>

#include "base/triangle_mesh.h"
#include "stock/octree/dual_contour.h"

namespace kerf {

/// The tiles of a field: tile (i, j, k) has the cells from (i, j, k) * cells_per_side on,
/// cells_per_side along each axis. Numbers may be negative.
struct DualTiles {
  int cells_per_side = 32;
  /// At least all that hold a cell with corners of both kinds; each once. In any order, which is
  /// that of the mesh's vertices and triangles.
  std::span<const std::array<int, 3>> tiles;

  CellBox box(const std::array<int, 3>& tile) const;
};

/// The surface, closed and of one piece in memory: vertices are shared. The surface of a field
/// whose outermost nodes are empty has no boundary edge, and whatever the field, no edge in other
/// than two triangles and no vertex whose triangles are not one ring. Positions are rounded to
/// single precision at the end.
///
/// `tolerance_mm` above 0: vertices on faces that are nearly plane, and on nearly straight edges
/// between them, are taken out (dual_contour_simplify.h); the result is a manifold of the same kind
/// and at most so far from the full mesh. About 0.4 us more for each vertex of the full mesh.
///
/// The result is the same, bit for bit, for any number of threads. Each holds one window of nodes;
/// besides these memory is that of the meshes.
TriangleMesh mesh_dual_field(const DualField& field, const DualTiles& tiles, double tolerance_mm,
                             int threads);

}  // namespace kerf
