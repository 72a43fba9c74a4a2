// twin/machines/mesh_builder.h - closed meshes from boxes, turned and extruded pieces.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "base/triangle_mesh.h"
#include "twin/machine/kinematics/pose.h"

namespace kerf {

/// Puts pieces together into one mesh. Each piece is closed by itself (every edge has two
/// triangles), with normals out; pieces may touch and overlap, nothing is united. Piece by piece
/// the corners are shared, so the mesh shades smooth where a turned piece is round. Lengths in mm.
///
/// `axis` 0, 1, 2: along X, Y, Z. The plane across it has (u, v) = (y, z), (z, x), (x, y).
class MeshBuilder {
 public:
  /// Corners in any order. A box without volume adds nothing.
  void box(const Vec3& a, const Vec3& b);
  /// A box with its four edges along `axis` cut off by `bevel_mm`, at most a third of the sides.
  void block(const Vec3& a, const Vec3& b, int axis, double bevel_mm);
  /// From `base` along the axis (against it, if length_mm < 0).
  void cylinder(const Vec3& base, int axis, double radius_mm, double length_mm);
  /// An outline turned around the axis through `base`: points are (radius, height above base). It
  /// is closed from its last point to its first and runs counter-clockwise, radius to the right and
  /// height up. Radii of 0 lie on the axis.
  void turned(const Vec3& base, int axis, std::span<const Vec2> outline);
  /// A simple polygon in (u, v), counter-clockwise, drawn out from `from` to `to` > from.
  void prism(std::span<const Vec2> outline, int axis, double from, double to);
  /// Another mesh, moved.
  void add(const TriangleMesh& mesh, const Pose& pose);

  const TriangleMesh& mesh() const { return mesh_; }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  std::uint32_t add_point(const Vec3& p);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  TriangleMesh mesh_;
};

/// Corners that belong to triangles.
Box bounds_of(const TriangleMesh& mesh);

/// Ear clipping: n - 2 triangles of a simple counter-clockwise polygon of n points. O(n^3) at
/// worst; outlines here have some dozens of points.
std::vector<std::array<std::uint32_t, 3>> triangles_of(std::span<const Vec2> outline);

}  // namespace kerf
