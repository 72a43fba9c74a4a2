// viewer/shaded_mesh.h - vertex normals for a triangle mesh: smooth where the surface is, split at
// sharp edges.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mesh_patch.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// Ready for a vertex buffer.
struct ShadedMesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< Three a triangle, in the order of the source mesh.
};

struct ShadingOptions {
  /// Two triangles that meet at a smaller angle share normals along their edge.
  double crease_deg = 30.0;
};

/// Normals weighted by the corner angle. Triangles without area are kept and do not count. Corners
/// are joined by index, not by position: a mesh without shared corners comes out flat-shaded.
/// O(corners), about 0.15 us each. Indices must be below positions_mm.size().
ShadedMesh shade_mesh(const TriangleMesh& mesh, const ShadingOptions& options);

}  // namespace kerf
