// twin/compare/triangle_tree.h - which point of a mesh is nearest to a point.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// Part of a triangle that a point of it lies on. Edge k runs from corner k to the next.
enum class TriangleFeature : std::uint8_t {
  kFace,
  kCorner0,
  kCorner1,
  kCorner2,
  kEdge0,
  kEdge1,
  kEdge2
};

/// A point of the mesh.
struct NearestPoint {
  Vec3 point_mm{0.0};
  double distance2_mm2 = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = 0;  ///< by TriangleTree's own order
  TriangleFeature feature = TriangleFeature::kFace;
};

/// Nearest point of a triangle; it may have no area. Exact but for rounding of double.
NearestPoint nearest_on_triangle(const std::array<glm::vec3, 3>& corners, const Vec3& p);

/// Bounding boxes in a binary tree, halved where the surface area heuristic says (J. Goldsmith,
/// J. Salmon, "Automatic creation of object hierarchies for ray tracing", 1987, with bins). Keeps
/// its own copy of the triangles, in the order of its leaves. Reading is thread-safe.
///
/// About 100 bytes a triangle, and 0.5 us a triangle to make.
class TriangleTree {
 public:
  /// `mesh` has at least one triangle.
  explicit TriangleTree(const TriangleMesh& mesh);

  std::size_t size() const { return triangles_.size(); }
  /// Number of a triangle in the mesh, from that in the tree.
  std::uint32_t number_in_mesh(std::uint32_t triangle) const { return numbers_[triangle]; }
  const std::array<glm::vec3, 3>& corners(std::uint32_t triangle) const {
    return triangles_[triangle];
  }
  const Box& box_mm() const { return box_mm_; }

  /// `hint`: a triangle that is likely near, such as that of a neighbouring point; the answer does
  /// not depend on it, the time does.
  NearestPoint nearest(const Vec3& p, std::uint32_t hint = 0) const;
  /// Triangles that the ray from `p` goes through.
  std::size_t crossings(const Vec3& p, const Vec3& direction) const;

 private:
  /// Two children with the box of each: a step down the tree reads one cache line.
  struct alignas(64) Node {
    std::array<std::array<float, 3>, 2> low, high;
    std::array<std::uint32_t, 2> first;  ///< a node, or the first triangle of a leaf
    std::array<std::uint32_t, 2> count;  ///< triangles of the leaf; 0: it is a node
  };
  static_assert(sizeof(Node) == 64);
  struct Item;
  struct Bounds;

  std::uint32_t build(std::span<Item> items, std::size_t offset, int depth);
  static std::size_t split(std::span<Item> items, int depth);

  std::vector<Node> nodes_;
  std::vector<std::array<glm::vec3, 3>> triangles_;
  std::vector<std::uint32_t> numbers_;
  Box box_mm_;
};

}  // namespace kerf
