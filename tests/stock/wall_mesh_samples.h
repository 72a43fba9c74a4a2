// tests/stock/wall_mesh_samples.h - what a mesh with upright walls is asked about.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "base/geometry.h"
#include "base/triangle_mesh.h"

namespace kerf::test {

/// Every edge is used once in each direction, by the places of its ends, not by their numbers.
inline bool is_closed(const TriangleMesh& mesh) {
  using Place = std::array<std::uint32_t, 3>;
  const auto place = [&](std::uint32_t v) {
    const glm::vec3 p = mesh.positions_mm[v] + 0.0f;
    return Place{std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                 std::bit_cast<std::uint32_t>(p.z)};
  };
  std::vector<std::pair<Place, Place>> edges, reversed;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace_back(place(t[k]), place(t[(k + 1) % 3]));
      reversed.emplace_back(edges.back().second, edges.back().first);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return !edges.empty() && edges == reversed &&
         std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

inline double enclosed_mm3(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]),
        c(mesh.positions_mm[t[2]]);
    sum += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return sum;
}

struct WallPoint {
  glm::dvec3 at;
  glm::dvec2 outward;  ///< of the wall
};

/// Middles and corners of the upright triangles that are not on the sides of the box.
inline std::vector<WallPoint> wall_points(const TriangleMesh& mesh, const Box& box) {
  std::vector<WallPoint> out;
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]),
        c(mesh.positions_mm[t[2]]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    if (!(length > 0) || std::abs(normal.z) > 1e-3 * length) continue;
    const glm::dvec2 outward = glm::dvec2(normal) / length;
    const glm::dvec3 middle = (a + b + c) / 3.0;
    const double side = 1e-4;
    if (middle.x < box.min.x + side || middle.x > box.max.x - side || middle.y < box.min.y + side ||
        middle.y > box.max.y - side)
      continue;
    for (const glm::dvec3& p : {a, b, c, middle}) out.push_back({p, outward});
  }
  return out;
}

}  // namespace kerf::test
