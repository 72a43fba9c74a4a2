#include "twin/machines/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/portable_math.h"

namespace kerf {
namespace {

constexpr std::uint32_t kSides = 32;  // of a turned piece: round at a glance

/// The point with (u, v) across and w along the axis.
Vec3 along(int axis, double u, double v, double w) {
  if (axis == 0) return {w, u, v};
  if (axis == 1) return {v, w, u};
  return {u, v, w};
}

/// Twice the area of a triangle, positive if counter-clockwise.
double turn_of(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_inside(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
  return turn_of(a, b, p) >= 0 && turn_of(b, c, p) >= 0 && turn_of(c, a, p) >= 0;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangles_of(std::span<const Vec2> outline) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> left(outline.size());
  std::iota(left.begin(), left.end(), 0U);
  const auto is_ear = [&](std::size_t i) {
    const std::size_t n = left.size();
    const Vec2& a = outline[left[(i + n - 1) % n]];
    const Vec2& b = outline[left[i]];
    const Vec2& c = outline[left[(i + 1) % n]];
    if (turn_of(a, b, c) <= 0) return false;
    return std::none_of(left.begin(), left.end(), [&](std::uint32_t k) {
      const Vec2& p = outline[k];
      return p != a && p != b && p != c && is_inside(p, a, b, c);
    });
  };
  while (left.size() > 3) {
    std::size_t ear = 0;
    while (ear < left.size() && !is_ear(ear)) ++ear;
    if (ear == left.size()) ear = 0;  // corners in a line: any triangle closes the piece
    const std::size_t n = left.size();
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

Box bounds_of(const TriangleMesh& mesh) {
  Box box;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) box.extend(Vec3(mesh.positions_mm[corner]));
  }
  return box;
}

std::uint32_t MeshBuilder::add_point(const Vec3& p) {
  mesh_.positions_mm.emplace_back(p);
  return static_cast<std::uint32_t>(mesh_.positions_mm.size() - 1);
}

void MeshBuilder::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh_.triangles.push_back({a, b, c});
}

void MeshBuilder::box(const Vec3& a, const Vec3& b) {
  const Vec3 low = glm::min(a, b);
  const Vec3 high = glm::max(a, b);
  if (low.x >= high.x || low.y >= high.y || low.z >= high.z) return;
  const std::array<Vec2, 4> outline{Vec2(low.x, low.y), Vec2(high.x, low.y), Vec2(high.x, high.y),
                                    Vec2(low.x, high.y)};
  prism(outline, 2, low.z, high.z);
}

void MeshBuilder::block(const Vec3& a, const Vec3& b, int axis, double bevel_mm) {
  const Vec3 low = glm::min(a, b);
  const Vec3 high = glm::max(a, b);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  if (low.x >= high.x || low.y >= high.y || low.z >= high.z) return;
  const double cut = std::min({bevel_mm, (high[u] - low[u]) / 3, (high[v] - low[v]) / 3});
  const std::array<Vec2, 8> outline{Vec2(low[u] + cut, low[v]),   Vec2(high[u] - cut, low[v]),
                                    Vec2(high[u], low[v] + cut),  Vec2(high[u], high[v] - cut),
                                    Vec2(high[u] - cut, high[v]), Vec2(low[u] + cut, high[v]),
                                    Vec2(low[u], high[v] - cut),  Vec2(low[u], low[v] + cut)};
  prism(outline, axis, low[axis], high[axis]);
}

void MeshBuilder::cylinder(const Vec3& base, int axis, double radius_mm, double length_mm) {
  const double low = std::min(0.0, length_mm);
  const double high = std::max(0.0, length_mm);
  const std::array<Vec2, 4> outline{Vec2(0, low), Vec2(radius_mm, low), Vec2(radius_mm, high),
                                    Vec2(0, high)};
  turned(base, axis, outline);
}

void MeshBuilder::turned(const Vec3& base, int axis, std::span<const Vec2> outline) {
  // First corner of each ring; a point on the axis is a ring of one.
  std::vector<std::uint32_t> rings;
  for (const Vec2& point : outline) {
    rings.push_back(static_cast<std::uint32_t>(mesh_.positions_mm.size()));
    const std::uint32_t corners = point.x > 0 ? kSides : 1;
    for (std::uint32_t side = 0; side < corners; ++side) {
      const double angle = 2 * kPi * side / kSides;
      add_point(base + along(axis, point.x * portable::cos(angle), point.x * portable::sin(angle),
                             point.y));
    }
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::size_t next = (i + 1) % outline.size();
    const bool wide = outline[i].x > 0;
    const bool next_wide = outline[next].x > 0;
    for (std::uint32_t side = 0; side < kSides; ++side) {
      const std::uint32_t other = (side + 1) % kSides;
      const std::uint32_t p = rings[i];
      const std::uint32_t q = rings[next];
      if (wide && next_wide) {
        add_triangle(p + side, p + other, q + other);
        add_triangle(p + side, q + other, q + side);
      } else if (wide) {
        add_triangle(p + side, p + other, q);
      } else if (next_wide) {
        add_triangle(p, q + other, q + side);
      }
    }
  }
}

void MeshBuilder::prism(std::span<const Vec2> outline, int axis, double from, double to) {
  const auto n = static_cast<std::uint32_t>(outline.size());
  const auto first = static_cast<std::uint32_t>(mesh_.positions_mm.size());
  for (const Vec2& p : outline) add_point(along(axis, p.x, p.y, from));
  for (const Vec2& p : outline) add_point(along(axis, p.x, p.y, to));
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    add_triangle(first + i, first + next, first + n + next);
    add_triangle(first + i, first + n + next, first + n + i);
  }
  for (const auto& [a, b, c] : triangles_of(outline)) {
    add_triangle(first + a, first + c, first + b);
    add_triangle(first + n + a, first + n + b, first + n + c);
  }
}

void MeshBuilder::add(const TriangleMesh& mesh, const Pose& pose) {
  const auto first = static_cast<std::uint32_t>(mesh_.positions_mm.size());
  for (const glm::vec3& p : mesh.positions_mm) add_point(pose.point(Vec3(p)));
  for (const auto& [a, b, c] : mesh.triangles) add_triangle(first + a, first + b, first + c);
}

}  // namespace kerf
