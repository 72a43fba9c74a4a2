// tests/twin/machines/mesh_support.h - what is true of closed meshes.
#pragma once

#include <cstddef>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "base/geometry.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// Edges that do not have exactly one triangle on either side.
inline std::size_t open_edges(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  std::size_t open = 0;
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) ++open;
  }
  return open;
}

/// By Gauss; positive if the normals point out.
inline double volume_mm3(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions_mm[t[0]]);
    const Vec3 b(mesh.positions_mm[t[1]]);
    const Vec3 c(mesh.positions_mm[t[2]]);
    sum += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return sum;
}

}  // namespace kerf
