// stock/octree/dual_contour_patch.h - the surface of one tile of a field, as triangles for a view.
#pragma once

#include "base/mesh_patch.h"
#include "stock/octree/dual_contour.h"

namespace kerf {

/// The quads that belong to `box` (see DualContour), `tile` and `version` left 0; cut_by only if
/// asked for. `contour` lends its memory. There are no skirts (skirt_begin == indices.size()), as
/// none are needed: patches meet in the same positions, whatever the levels of either.
///
/// Level 0 has all vertices. Where faces of the part meet at more than 28 degrees each has its own
/// vertex at the same place, with its own normal; elsewhere normals are the surface's own.
///
/// Level n joins the vertices in groups of 2^n cells per side, each connected piece of surface in a
/// group for itself, to one vertex near the faces and edges of the part; triangles that end up
/// without an area go. Vertices of the tile's outer layers of cells are not joined, so the border
/// of a patch is the same at each level:
///
///      o-o-o-o-o-o     The surface of all tiles at any levels is closed: each edge, by the
///      |\|/|\|/|\|     positions of its ends, is passed equally often in both directions. At
///      o-- o - o-o     levels above 0 pieces may touch.
///      |/|  \ / \|
///      o-o-o-o-o-o     A plane of 32 x 32 cells has 2048, 638, 254, 158
///                      and 134 triangles at levels 0 to 4, with 128 edges round the border.
MeshPatch make_dual_patch(const DualField& field, const CellBox& box, int level, bool keeps_cut_ids,
                          DualContour* contour);

}  // namespace kerf
