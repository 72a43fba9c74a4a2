// stock/zmap/height_mesh.h - closed triangle mesh of a height grid: top, walls, floor.
#pragma once

#include <span>

#include "base/geometry.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// Heights of nx x ny cells, row by row (y outer), mm. bounds_mm: x, y edges of the grid, min.z the floor. A cell whose
/// height is <= the floor holds no material (a hole through the workpiece, or outside a round blank).
struct HeightGrid {
  int nx = 0;
  int ny = 0;
  Box bounds_mm;
  std::span<const float> heights_mm;
};

/// The surface that interpolates the heights at the cell centres linearly over triangles, is carried on level from the
/// outer centres to the edge of the grid, and is closed by vertical walls and a floor.
/// tolerance_mm = 0: every cell is a vertex, all squares are divided along the same diagonal, and the enclosed volume is
/// the sum of height x cell area. tolerance_mm > 0: fewer triangles, nowhere further than that from the full surface
/// (measured vertically).
/// Result: closed, every edge in exactly two triangles, normals outward. threads >= 1; same result for any.
TriangleMesh mesh_height_grid(const HeightGrid& grid, double tolerance_mm, int threads = 1);

}  // namespace kerf
