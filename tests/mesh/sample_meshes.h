// tests/mesh/sample_meshes.h - closed meshes of known bodies, and whether a point is in one.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "base/triangle_mesh.h"
#include "mesh/mesh_body.h"

namespace kerf::test {

/// A convex polygon, counter-clockwise, from low to high.
inline void add_prism(TriangleMesh& mesh, std::span<const Vec2> polygon, double low, double high) {
  const auto base = static_cast<std::uint32_t>(mesh.positions_mm.size());
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const double z : {low, high})
    for (const Vec2& p : polygon) mesh.positions_mm.emplace_back(glm::vec3(p.x, p.y, z));
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    mesh.triangles.push_back({base + k, base + next, base + n + next});
    mesh.triangles.push_back({base + k, base + n + next, base + n + k});
    if (k < 2) continue;
    mesh.triangles.push_back({base, base + k, base + k - 1});
    mesh.triangles.push_back({base + n, base + n + k - 1, base + n + k});
  }
}
inline void add_box(TriangleMesh& mesh, const Vec3& low, const Vec3& high) {
  const Vec2 around[4] = {{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}};
  add_prism(mesh, around, low.z, high.z);
}
inline TriangleMesh box_of(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  add_box(mesh, low, high);
  return mesh;
}
/// Corners on the circle.
inline std::vector<Vec2> circle(double radius, int corners) {
  std::vector<Vec2> out;
  for (int k = 0; k < corners; ++k)
    out.emplace_back(radius * std::cos(2 * kPi * k / corners),
                     radius * std::sin(2 * kPi * k / corners));
  return out;
}
/// A ring about Z whose section is this polygon of (z, r), all r above 0, clockwise.
inline TriangleMesh ring_of(std::span<const Vec2> section, int around) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(around), m = static_cast<std::uint32_t>(section.size());
  for (std::uint32_t k = 0; k < n; ++k) {
    const double turn = 2 * kPi * k / n;
    for (const Vec2& p : section)
      mesh.positions_mm.emplace_back(glm::vec3(p.y * std::cos(turn), p.y * std::sin(turn), p.x));
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    for (std::uint32_t i = 0; i < m; ++i) {
      const std::uint32_t a = k * m + i, b = k * m + (i + 1) % m;
      const std::uint32_t c = (k + 1) % n * m + i, d = (k + 1) % n * m + (i + 1) % m;
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a, d, b});
    }
  }
  return mesh;
}
/// Of rings from the south pole to the north, its corners on the sphere.
inline TriangleMesh sphere(const Vec3& center, double radius, int around) {
  TriangleMesh mesh;
  const int rings = around / 2;
  const auto n = static_cast<std::uint32_t>(around);
  mesh.positions_mm.emplace_back(glm::vec3(center - Vec3(0, 0, radius)));
  for (int r = 1; r < rings; ++r) {
    const double up = kPi * r / rings - kPi / 2;
    for (int k = 0; k < around; ++k) {
      const double turn = 2 * kPi * k / around;
      mesh.positions_mm.emplace_back(
          glm::vec3(center + radius * Vec3(std::cos(up) * std::cos(turn),
                                           std::cos(up) * std::sin(turn), std::sin(up))));
    }
  }
  mesh.positions_mm.emplace_back(glm::vec3(center + Vec3(0, 0, radius)));
  const auto top = static_cast<std::uint32_t>(mesh.positions_mm.size() - 1);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    mesh.triangles.push_back({0, 1 + next, 1 + k});
    for (std::uint32_t r = 0; r + 2 < static_cast<std::uint32_t>(rings); ++r) {
      const std::uint32_t low = 1 + r * n, high = low + n;
      mesh.triangles.push_back({low + k, low + next, high + next});
      mesh.triangles.push_back({low + k, high + next, high + k});
    }
    mesh.triangles.push_back({top - n + k, top - n + next, top});
  }
  return mesh;
}

/// Of a sound mesh.
inline MeshBody body_of(const TriangleMesh& mesh) {
  Result<MeshBody> body = mesh_body(mesh, "a.stl");
  EXPECT_TRUE(body) << body.error();
  return std::move(body.value());
}

/// How often the mesh winds about a point, by the solid angles of its triangles (A. Van Oosterom,
/// J. Strackee, 1983).
inline double winding_number(const TriangleMesh& mesh, const Vec3& p) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = Vec3(mesh.positions_mm[t[0]]) - p, b = Vec3(mesh.positions_mm[t[1]]) - p,
               c = Vec3(mesh.positions_mm[t[2]]) - p;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += 2 * std::atan2(
                   glm::dot(a, glm::cross(b, c)),
                   la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (4 * kPi);
}

inline double volume_mm3(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += glm::dot(Vec3(mesh.positions_mm[t[0]]),
                    glm::cross(Vec3(mesh.positions_mm[t[1]]), Vec3(mesh.positions_mm[t[2]]))) /
           6;
  return sum;
}

/// Turned lumps that overlap each other or not, all of them the right way round.
inline TriangleMesh random_lumps(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> at(-8, 8), size(1, 6), angle(0, 2 * kPi);
  TriangleMesh mesh;
  for (int n = 0; n < count; ++n) {
    TriangleMesh lump;
    const double radius = size(random);
    if (n % 2 == 0) {
      const double low = -size(random), high = size(random);
      add_prism(lump, circle(radius, 3 + n % 5), low, high);
    } else {
      lump = sphere(Vec3(0), radius, 8);
    }
    const double a = angle(random), b = angle(random);
    const Vec3 shift{at(random), at(random), at(random)};
    const auto base = static_cast<std::uint32_t>(mesh.positions_mm.size());
    for (const glm::vec3& p : lump.positions_mm) {
      const Vec3 q(p);
      const Vec3 r(q.x * std::cos(a) - q.y * std::sin(a), q.x * std::sin(a) + q.y * std::cos(a),
                   q.z);
      mesh.positions_mm.emplace_back(
          glm::vec3(shift + Vec3(r.x, r.y * std::cos(b) - r.z * std::sin(b),
                                 r.y * std::sin(b) + r.z * std::cos(b))));
    }
    for (const auto& t : lump.triangles)
      mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
  }
  return mesh;
}

}  // namespace kerf::test
