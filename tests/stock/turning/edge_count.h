// tests/stock/turning/edge_count.h - whether triangles close, and what they enclose.
#pragma once

#include <glm/geometric.hpp>
#include <map>
#include <tuple>
#include <utility>

#include "base/mesh_patch.h"
#include "base/triangle_mesh.h"

namespace kerf::turning_test {

using Key = std::tuple<float, float, float>;
inline Key key(const glm::vec3& p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }

/// Each directed edge as often as its reverse, by places.
class EdgeCount {
 public:
  void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      ++edges_[{key(p), key(q)}];
      --edges_[{key(q), key(p)}];
    }
    const glm::dvec3 u(a), v(b), w(c);
    volume_ += glm::dot(u, glm::cross(v, w)) / 6;
  }
  int unpaired() const {
    int count = 0;
    for (const auto& [edge, sum] : edges_) count += sum != 0;
    return count;
  }
  double volume_mm3() const { return volume_; }

 private:
  std::map<std::pair<Key, Key>, int> edges_;
  double volume_ = 0;
};

inline EdgeCount count(const TriangleMesh& mesh) {
  EdgeCount edges;
  for (const auto& t : mesh.triangles) {
    edges.add(mesh.positions_mm[t[0]], mesh.positions_mm[t[1]], mesh.positions_mm[t[2]]);
  }
  return edges;
}

inline EdgeCount count(const MeshPatch& patch) {
  EdgeCount edges;
  for (std::size_t i = 0; i < patch.indices.size(); i += 3) {
    edges.add(patch.vertices[patch.indices[i]].position_mm,
              patch.vertices[patch.indices[i + 1]].position_mm,
              patch.vertices[patch.indices[i + 2]].position_mm);
  }
  return edges;
}

}  // namespace kerf::turning_test
