// stock/sheet/sheet_mesh.h - the sheet, extruded.
#pragma once

#include "base/mesh_patch.h"
#include "base/triangle_mesh.h"
#include "stock/sheet/sheet_grid.h"

namespace kerf::sheet {

/// Closed, however the rings touch: every edge of a triangle is one of another, turned round.
TriangleMesh extrude(const SheetGrid& grid, double bottom_mm, double top_mm);

/// One tile's share. Corners of walls where these turn by less than 30 degrees have one normal.
MeshPatch extrude_tile(const SheetGrid& grid, std::size_t tile, double bottom_mm, double top_mm);

}  // namespace kerf::sheet
