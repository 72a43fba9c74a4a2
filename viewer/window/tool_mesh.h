// viewer/window/tool_mesh.h - the outline of a tool turned around its axis, and its plates.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/mesh_patch.h"
#include "viewer/scene.h"

namespace kerf {

struct ToolMesh {
  struct Part {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
  };
  std::vector<MeshVertex> vertices;  ///< Tip at the origin, axis along +Z.
  std::vector<std::uint32_t> indices;
  std::array<Part, kToolPieceCount> pieces;  ///< By ToolPiece.
  Box bounds_mm;
};

/// Normals are smooth around the axis and, along the outline, where it bends by little.
///
/// A plate is of the cutter, but for the middle of its face, which is of the shank: so its edges
/// show. One that holds it is of the holder.
ToolMesh tool_mesh(const ToolShape& shape);

}  // namespace kerf
