// base/triangle_mesh.h - an indexed triangle mesh, the one currency between stock models, files and
// pictures.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace kerf {

/// Corners in mm, single precision; triangles counter-clockwise seen from outside (normals point
/// out of the material).
struct TriangleMesh {
  std::vector<glm::vec3> positions_mm;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

}  // namespace kerf
