// viewer/mesh_rays.h - where rays meet a mesh. For the sources of viewer/ only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "base/geometry.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// A tree of boxes over the triangles. Making it takes about 1 us a triangle and 20 bytes, a
/// question some microseconds.
class MeshRays {
 public:
  MeshRays() = default;
  /// `mesh` may be null: nothing is hit.
  explicit MeshRays(std::shared_ptr<const TriangleMesh> mesh);

  /// A triangle, seen from either side, lies on the way from one point to the other.
  bool hits(const Vec3& from_mm, const Vec3& to_mm) const;

  struct Hit {
    double t = 0.0;              ///< share of the way
    std::uint32_t triangle = 0;  ///< of the mesh
    double u = 0.0, v = 0.0;     ///< weights of its second and third corner
  };
  /// The first triangle that is seen from outside, on the way from `from_mm` on without an end, and
  /// before share `before_t` of it.
  std::optional<Hit> first_front(const Vec3& from_mm, const Vec3& way_mm, double before_t) const;

 private:
  struct Node {
    glm::vec3 min{0.0f}, max{0.0f};
    std::uint32_t first = 0;  ///< of its triangles; of a node that is split, the second half's node
    std::uint32_t count = 0;  ///< of its triangles; 0: it is split, the first half comes next
  };

  void build(std::size_t first, std::size_t count, const std::vector<glm::vec3>& middles);
  struct Met {
    Hit hit;
    bool is_front = false;
  };
  std::optional<Met> meet(std::size_t which, const Vec3& from_mm, const Vec3& way_mm) const;
  /// Calls leaf(which) for triangles that the way may meet up to share end(); until it says true.
  template <class End, class Leaf>
  bool walk(const Vec3& from_mm, const Vec3& way_mm, const End& end, const Leaf& leaf) const;

  std::shared_ptr<const TriangleMesh> mesh_;
  std::vector<std::uint32_t> order_;  ///< of triangles, as the leaves have them
  std::vector<Node> nodes_;
};

}  // namespace kerf
