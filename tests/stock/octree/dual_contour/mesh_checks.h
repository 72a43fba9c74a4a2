// tests/stock/octree/dual_contour/mesh_checks.h - what a closed mesh must be.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/geometry.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// Empty for a closed oriented 2-manifold: each edge in two triangles, once in each direction; the
/// triangles at each vertex one ring; no vertex unused. Else what is wrong.
inline std::string manifold_fault(const TriangleMesh& mesh) {
  // Of each vertex: the corners after and before it in its triangles.
  using Ends = std::array<std::uint32_t, 2>;
  std::vector<std::uint32_t> begin(mesh.positions_mm.size() + 1, 0);
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return "triangle with equal corners";
    for (const std::uint32_t corner : t) ++begin[corner + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Ends> all(3 * mesh.triangles.size());
  std::vector<std::uint32_t> place(begin.begin(), begin.end() - 1);
  for (const auto& t : mesh.triangles)
    for (std::size_t n = 0; n < 3; ++n) all[place[t[n]]++] = {t[(n + 1) % 3], t[(n + 2) % 3]};
  for (std::size_t vertex = 0; vertex + 1 < begin.size(); ++vertex) {
    const auto ends =
        std::span<const Ends>(all).subspan(begin[vertex], begin[vertex + 1] - begin[vertex]);
    if (ends.empty()) return "unused vertex";
    const auto count = [&](std::size_t side, std::uint32_t corner) {
      return std::count_if(ends.begin(), ends.end(),
                           [&](const Ends& e) { return e[side] == corner; });
    };
    for (const Ends& e : ends) {
      if (count(0, e[0]) > 1) return "edge twice in one direction";
      if (count(1, e[0]) != 1 || count(0, e[1]) != 1) return "boundary edge";
    }
    std::uint32_t at = ends[0][0];
    std::size_t steps = 0;
    do {
      at = (*std::find_if(ends.begin(), ends.end(), [&](const Ends& e) { return e[0] == at; }))[1];
      ++steps;
    } while (at != ends[0][0]);
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
