// tests/stock/octree/dual_contour/mesh_checks.h - what a closed mesh must be.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/geometry.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// Empty for a closed oriented 2-manifold: each edge in two triangles, once in each direction; the
/// triangles at each vertex one ring; no vertex unused. Else what is wrong.
inline std::string manifold_fault(const TriangleMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ways;
  std::vector<std::vector<std::array<std::uint32_t, 2>>> around(mesh.positions_mm.size());
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return "triangle with equal corners";
    for (std::size_t n = 0; n < 3; ++n) {
      ways.emplace_back(t[n], t[(n + 1) % 3]);
      around[t[n]].push_back({t[(n + 1) % 3], t[(n + 2) % 3]});
    }
  }
  std::sort(ways.begin(), ways.end());
  for (std::size_t n = 0; n < ways.size(); ++n) {
    if (n > 0 && ways[n] == ways[n - 1]) return "edge twice in one direction";
    if (!std::binary_search(ways.begin(), ways.end(), std::pair(ways[n].second, ways[n].first)))
      return "boundary edge";
  }
  for (const auto& ends : around) {
    if (ends.empty()) return "unused vertex";
    std::uint32_t at = ends[0][0];
    std::size_t steps = 0;
    do {
      const auto next =
          std::find_if(ends.begin(), ends.end(), [&](const auto& pair) { return pair[0] == at; });
      if (next == ends.end()) return "open ring";
      at = (*next)[1];
      ++steps;
    } while (at != ends[0][0] && steps <= ends.size());
    if (steps != ends.size()) return "two rings at a vertex";
  }
  return {};
}

inline double mesh_volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]), c(mesh.positions_mm[t[2]]);
    sum += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return sum;
}

inline double mesh_area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]), c(mesh.positions_mm[t[2]]);
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

/// Greatest distance of points all over the mesh from the surface of a body whose distance is exact
/// near it.
template <class Body>
double farthest_mm(const TriangleMesh& mesh, const Body& body, int steps = 4) {
  double farthest = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]), c(mesh.positions_mm[t[2]]);
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const Vec3 at = (double(i) * a + double(j) * b + double(steps - i - j) * c) / double(steps);
        farthest = std::max(farthest, std::abs(body.distance(at)));
      }
    }
  }
  return farthest;
}
template <class Body>
double farthest_vertex_mm(const TriangleMesh& mesh, const Body& body) {
  double farthest = 0.0;
  for (const glm::vec3& at : mesh.positions_mm)
    farthest = std::max(farthest, std::abs(body.distance(Vec3(at))));
  return farthest;
}

}  // namespace kerf
