// tests/twin/compare/meshes.h - design parts whose distances are known.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "base/geometry.h"
#include "base/triangle_mesh.h"

namespace kerf::test {

inline TriangleMesh box_mesh(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  for (int n = 0; n < 8; ++n) {
    mesh.positions_mm.emplace_back((n & 1) != 0 ? high.x : low.x, (n & 2) != 0 ? high.y : low.y,
                                   (n & 4) != 0 ? high.z : low.z);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A block with a pocket in its top, which stands along X and Y.
inline TriangleMesh pocketed_mesh(const Box& block, const Vec2& low, const Vec2& high,
                                  double floor) {
  TriangleMesh mesh;
  const auto add = [&](double x, double y, double z) { mesh.positions_mm.emplace_back(x, y, z); };
  for (const double z : {block.min.z, block.max.z}) {
    add(block.min.x, block.min.y, z), add(block.max.x, block.min.y, z);
    add(block.max.x, block.max.y, z), add(block.min.x, block.max.y, z);
  }
  for (const double z : {floor, block.max.z}) {
    add(low.x, low.y, z), add(high.x, low.y, z), add(high.x, high.y, z), add(low.x, high.y, z);
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  quad(3, 2, 1, 0);
  quad(8, 9, 10, 11);
  for (std::uint32_t n = 0; n < 4; ++n) {
    const std::uint32_t m = (n + 1) % 4;
    quad(n, m, m + 4, n + 4);
    quad(m + 8, n + 8, n + 12, m + 12);
    quad(n + 4, m + 4, m + 12, n + 12);
  }
  return mesh;
}

/// A surface of revolution about z: `radius(v)` and `height(v)` of v in 0 .. 1, closed at both ends
/// (where the radius must be 0).
template <class Radius, class Height>
TriangleMesh turned_mesh(int around, int along, const Radius& radius, const Height& height) {
  TriangleMesh mesh;
  const auto add = [&](double v, int n) {
    const double angle = 2 * kPi * n / around;
    mesh.positions_mm.emplace_back(radius(v) * std::cos(angle), radius(v) * std::sin(angle),
                                   height(v));
  };
  mesh.positions_mm.emplace_back(0, 0, height(0.0));
  for (int k = 1; k < along; ++k) {
    for (int n = 0; n < around; ++n) add(static_cast<double>(k) / along, n);
  }
  mesh.positions_mm.emplace_back(0, 0, height(1.0));
  const auto at = [&](int k, int n) {
    if (k == 0) return 0U;
    if (k == along) return static_cast<std::uint32_t>(mesh.positions_mm.size() - 1);
    return static_cast<std::uint32_t>(1 + (k - 1) * around + n % around);
  };
  for (int k = 0; k < along; ++k) {
    for (int n = 0; n < around; ++n) {
      if (k > 0) mesh.triangles.push_back({at(k, n), at(k, n + 1), at(k + 1, n)});
      if (k + 1 < along) mesh.triangles.push_back({at(k, n + 1), at(k + 1, n + 1), at(k + 1, n)});
    }
  }
  return mesh;
}

inline TriangleMesh sphere_mesh(double radius_mm, int around) {
  return turned_mesh(
      around, around / 2, [&](double v) { return radius_mm * std::sin(kPi * v); },
      [&](double v) { return -radius_mm * std::cos(kPi * v); });
}

/// From z = 0 up.
inline TriangleMesh cylinder_mesh(double radius_mm, double height_mm, int around) {
  return turned_mesh(
      around, 3, [&](double v) { return v > 0.1 && v < 0.9 ? radius_mm : 0.0; },
      [&](double v) { return v < 0.5 ? 0.0 : height_mm; });
}

inline double box_distance_mm(const Vec3& low, const Vec3& high, const Vec3& p) {
  const Vec3 middle = 0.5 * (low + high), half = 0.5 * (high - low);
  double outside2 = 0, inside = -1e300;
  for (int k = 0; k < 3; ++k) {
    const double off = std::abs(p[k] - middle[k]) - half[k];
    outside2 += off > 0 ? off * off : 0;
    inside = std::max(inside, off);
  }
  return inside > 0 ? std::sqrt(outside2) : inside;
}

}  // namespace kerf::test
