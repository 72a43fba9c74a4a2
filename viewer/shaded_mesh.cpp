#include "viewer/shaded_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "base/geometry.h"

namespace kerf {
namespace {

/// Fans up to this size search their neighbours directly, larger ones by bisection.
constexpr std::size_t kSmallFan = 12;

struct Face {
  glm::vec3 normal{0.0f};
  float double_area_mm2 = 0.0f;
};

/// One triangle as seen from the vertex at hand: `vertex` -> next -> previous runs
/// counter-clockwise.
struct Spoke {
  std::uint32_t corner;  // 3 * triangle + which
  std::uint32_t next;
  std::uint32_t previous;
  std::uint32_t group;  // union-find parent, an index into the fan
};

std::uint32_t root(std::vector<Spoke>& fan, std::uint32_t i) {
  while (fan[i].group != i) i = fan[i].group = fan[fan[i].group].group;
  return i;
}

class Shader {
 public:
  Shader(const TriangleMesh& mesh, const ShadingOptions& options)
      : mesh_(mesh), crease_cos_(static_cast<float>(std::cos(options.crease_deg * kPi / 180.0))) {}

  ShadedMesh run() {
    find_faces();
    find_corners_of_vertices();
    ShadedMesh shaded;
    shaded.indices.resize(mesh_.triangles.size() * 3);
    shaded.vertices.reserve(mesh_.positions_mm.size() * 5 / 4);
    for (std::uint32_t v = 0; v < mesh_.positions_mm.size(); ++v) shade_vertex(v, &shaded);
    return shaded;
  }

 private:
  void find_faces() {
    faces_.resize(mesh_.triangles.size());
    for (std::size_t t = 0; t < faces_.size(); ++t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      assert(std::max({a, b, c}) < mesh_.positions_mm.size());
      const glm::vec3 origin = mesh_.positions_mm[a];
      const glm::vec3 n =
          glm::cross(mesh_.positions_mm[b] - origin, mesh_.positions_mm[c] - origin);
      const float length = glm::length(n);
      if (length > 0.0f) faces_[t] = {n / length, length};
    }
  }

  /// corners_[first_[v] .. first_[v + 1]) are the corners at vertex v.
  void find_corners_of_vertices() {
    first_.assign(mesh_.positions_mm.size() + 1, 0);
    for (const auto& triangle : mesh_.triangles) {
      for (const std::uint32_t v : triangle) ++first_[v + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> at(first_.begin(), first_.end() - 1);
    corners_.resize(mesh_.triangles.size() * 3);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k) corners_[at[mesh_.triangles[t][k]]++] = 3 * t + k;
    }
  }

  /// Calls use(i, j) for all spokes whose triangles share the edge from v to fan_[i].next ==
  /// fan_[j].previous.
  template <class Use>
  void for_each_edge(const Use& use) {
    const auto size = static_cast<std::uint32_t>(fan_.size());
    if (size <= kSmallFan) {
      for (std::uint32_t i = 0; i < size; ++i) {
        for (std::uint32_t j = 0; j < size; ++j) {
          if (fan_[i].next == fan_[j].previous) use(i, j);
        }
      }
      return;
    }
    by_previous_.resize(size);
    std::iota(by_previous_.begin(), by_previous_.end(), 0u);
    std::sort(by_previous_.begin(), by_previous_.end(), [&](std::uint32_t i, std::uint32_t j) {
      return fan_[i].previous < fan_[j].previous;
    });
    for (std::uint32_t i = 0; i < size; ++i) {
      auto found = std::lower_bound(
          by_previous_.begin(), by_previous_.end(), fan_[i].next,
          [&](std::uint32_t j, std::uint32_t next) { return fan_[j].previous < next; });
      for (; found != by_previous_.end() && fan_[*found].previous == fan_[i].next; ++found) {
        use(i, *found);
      }
    }
  }

  /// Joins the triangles of the fan around v that share normals: those that meet smoothly.
  void group_fan() {
    for_each_edge([&](std::uint32_t i, std::uint32_t j) {
      const float cosine =
          glm::dot(faces_[fan_[i].corner / 3].normal, faces_[fan_[j].corner / 3].normal);
      if (cosine > crease_cos_) fan_[root(fan_, i)].group = root(fan_, j);
    });
  }

  /// Makes one vertex per group of the fan around v and writes it into the indices of the group's
  /// corners.
  void shade_vertex(std::uint32_t v, ShadedMesh* shaded) {
    fan_.clear();
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
      const std::uint32_t corner = corners_[i];
      const auto& triangle = mesh_.triangles[corner / 3];
      const std::uint32_t k = corner % 3;
      fan_.push_back({corner, triangle[(k + 1) % 3], triangle[(k + 2) % 3], i - first_[v]});
    }
    group_fan();
    sums_.assign(fan_.size(), glm::vec3(0.0f));
    const glm::vec3 p = mesh_.positions_mm[v];
    for (std::uint32_t i = 0; i < fan_.size(); ++i) {
      const Face& face = faces_[fan_[i].corner / 3];
      const float cosine_part =
          glm::dot(mesh_.positions_mm[fan_[i].next] - p, mesh_.positions_mm[fan_[i].previous] - p);
      const float angle_rad = std::atan2(face.double_area_mm2, cosine_part);
      sums_[root(fan_, i)] += angle_rad * face.normal;
    }
    made_.assign(fan_.size(), 0);
    for (std::uint32_t i = 0; i < fan_.size(); ++i) {
      const std::uint32_t group = root(fan_, i);
      if (made_[group] == 0) {
        const float length = glm::length(sums_[group]);
        const glm::vec3 n = length > 0.0f ? sums_[group] / length : glm::vec3(0, 0, 1);
        shaded->vertices.push_back({p, pack_normal(n)});
        made_[group] = static_cast<std::uint32_t>(shaded->vertices.size());  // index + 1
      }
      shaded->indices[fan_[i].corner] = made_[group] - 1;
    }
  }

  const TriangleMesh& mesh_;
  const float crease_cos_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> corners_;
  // Scratch of one vertex, kept to spare allocations.
  std::vector<Spoke> fan_;
  std::vector<std::uint32_t> by_previous_;
  std::vector<glm::vec3> sums_;
  std::vector<std::uint32_t> made_;
};

}  // namespace

ShadedMesh shade_mesh(const TriangleMesh& mesh, const ShadingOptions& options) {
  return Shader(mesh, options).run();
}

}  // namespace kerf
