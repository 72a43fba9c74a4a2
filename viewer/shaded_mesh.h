// viewer/shaded_mesh.h - vertex normals for a triangle mesh: smooth where the surface is, split at
// sharp edges.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "base/triangle_mesh.h"

namespace kerf {

/// Ready for a vertex buffer.
struct ShadedVertex {
  glm::vec3 position_mm;
  std::uint32_t
      normal;  ///< x, y, z as signed 10-bit fractions from bit 0 up (GL_INT_2_10_10_10_REV).
};

struct ShadedMesh {
  std::vector<ShadedVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< Three a triangle, in the order of the source mesh.
};

struct ShadingOptions {
  /// Two triangles that meet at a smaller angle share normals along their edge.
  double crease_deg = 30.0;
  /// At a corner, two smooth groups of triangles that both reach less than this from their common
  /// edge share normals whatever their angle: the crease is too small to be seen as one, and would
  /// only glitter. Walls of height grids that run askew to the grid are such zigzags one cell wide.
  /// About the size of a pixel.
  double smallest_visible_mm = 0.0;
};

/// Normals weighted by the corner angle. Triangles without area are kept and do not count. Corners
/// are joined by index, not by position: a mesh without shared corners comes out flat-shaded.
/// O(corners), about 0.15 us each. Indices must be below positions_mm.size().
ShadedMesh shade_mesh(const TriangleMesh& mesh, const ShadingOptions& options);

}  // namespace kerf
