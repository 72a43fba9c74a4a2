// mesh/mesh_lines.h - what of parallel lines lies within a body of triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/triangle_mesh.h"
#include "mesh/column_lines.h"

namespace kerf {

/// Where a line enters or leaves the body.
struct LineEnd {
  float at_mm = 0;             ///< along the axis
  std::uint32_t triangle = 0;  ///< of the mesh
};

/// Lines along an axis through the middles of the cells of a grid, which lies across it: of the
/// axes that follow each other as x y z x y, `grid` has the two that follow `axis` (for z: x and
/// y). Exact but for rounding to float, however triangles lie on the grid (column_lines.h): lines
/// of all three axes count as if they stood by the same little away from where they are, towards
/// -X, farther towards +Y, and farthest towards +Z. So where lines of several axes meet in a point
/// of the surface, they agree on which side of it that is.
/// `mesh`: closed; of one that is open, whatever its lines see.
/// Time: some 10 ns a triangle and as much for each crossing; 16 bytes a crossing.
class MeshLines {
 public:
  MeshLines(const TriangleMesh& mesh, int axis, const ColumnGrid& grid);

  /// Of the line through a cell: it enters at the first, leaves at the second, and so on, upward.
  std::span<const LineEnd> ends(std::size_t cell) const {
    return std::span(ends_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<LineEnd> ends_;
};

}  // namespace kerf
