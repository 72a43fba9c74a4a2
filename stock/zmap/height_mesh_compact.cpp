#include "stock/zmap/height_mesh_compact.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#include "stock/zmap/height_mesh_parallel.h"

namespace kerf {
namespace {

constexpr std::size_t kLeastTriangles = 1 << 16;

/// The index of a key is the number of used keys before it.
class Numbering {
 public:
  explicit Numbering(const std::vector<std::uint64_t>& used) : used_(used) {
    before_word_.reserve(used.size() + 1);
    std::uint32_t count = 0;
    for (const std::uint64_t word : used) {
      before_word_.push_back(count);
      count += std::uint32_t(std::popcount(word));
    }
    before_word_.push_back(count);
  }
  std::size_t count() const { return before_word_.back(); }
  std::size_t words() const { return used_.size(); }
  std::uint64_t word(std::size_t w) const { return used_[w]; }
  std::uint32_t index(NodeKey key) const {
    const std::uint64_t lower_bits = (std::uint64_t{1} << (key % 64)) - 1;
    return before_word_[key / 64] + std::uint32_t(std::popcount(used_[key / 64] & lower_bits));
  }

 private:
  const std::vector<std::uint64_t>& used_;
  std::vector<std::uint32_t> before_word_;
};

/// Calls visit(key, index) for the used keys of words [begin, end).
template <class Visit>
void for_each_used(const Numbering& numbering, std::size_t begin, std::size_t end,
                   const Visit& visit) {
  for (std::size_t w = begin; w < end; ++w) {
    std::uint64_t bits = numbering.word(w);
    if (bits == 0) continue;
    std::uint32_t index = numbering.index(NodeKey(w * 64));
    for (; bits != 0; bits &= bits - 1) {
      visit(NodeKey(w * 64 + std::size_t(std::countr_zero(bits))), index++);
    }
  }
}

/// A triangle at a vertex.
struct Corner {
  std::uint32_t vertex;
  std::uint32_t triangle;
};

class FanSplitter {
 public:
  explicit FanSplitter(TriangleMesh& mesh) : mesh_(mesh) {}

  /// Gives each closed fan of triangles around corners[first..last), all of one vertex, its own
  /// vertex; the first keeps the old one.
  void split(std::vector<Corner>& corners, std::size_t first, std::size_t last) {
    const std::uint32_t old_vertex = corners[first].vertex;
    std::uint32_t vertex = old_vertex;
    while (first < last) {
      std::size_t end = first + 1;  // [first, end): the fan so far, walked counter-clockwise
      while (bring_next(corners, end, last, old_vertex)) ++end;
      if (vertex != old_vertex) {
        for (std::size_t c = first; c < end; ++c) {
          slot(corners[c].triangle, old_vertex) = vertex;
        }
      }
      first = end;
      if (first < last) {
        vertex = std::uint32_t(mesh_.positions_mm.size());
        const glm::vec3 position = mesh_.positions_mm[old_vertex];
        mesh_.positions_mm.push_back(position);
      }
    }
  }

 private:
  std::uint32_t& slot(std::uint32_t triangle, std::uint32_t vertex) {
    auto& corners = mesh_.triangles[triangle];
    return corners[0] == vertex ? corners[0] : corners[1] == vertex ? corners[1] : corners[2];
  }
  std::uint32_t follower(std::uint32_t triangle, std::uint32_t vertex, std::size_t steps) const {
    const auto& corners = mesh_.triangles[triangle];
    const std::size_t at = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
    return corners[(at + steps) % 3];
  }
  /// Moves the neighbour of corner end - 1 across its last edge to `end`, if it is not yet taken.
  bool bring_next(std::vector<Corner>& corners, std::size_t end, std::size_t last,
                  std::uint32_t vertex) const {
    const std::uint32_t edge_end = follower(corners[end - 1].triangle, vertex, 2);
    for (std::size_t c = end; c < last; ++c) {
      if (follower(corners[c].triangle, vertex, 1) == edge_end) {
        std::swap(corners[c], corners[end]);
        return true;
      }
    }
    return false;
  }
  TriangleMesh& mesh_;
};

/// is_shared[v]: vertex v may have several fans.
void split_fans(TriangleMesh& mesh, const std::vector<bool>& is_shared) {
  std::vector<Corner> corners;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      if (is_shared[vertex]) corners.push_back({vertex, std::uint32_t(t)});
    }
  }
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Corner& a, const Corner& b) { return a.vertex < b.vertex; });
  FanSplitter splitter(mesh);
  for (std::size_t first = 0; first < corners.size();) {
    std::size_t last = first + 1;
    while (last < corners.size() && corners[last].vertex == corners[first].vertex) ++last;
    splitter.split(corners, first, last);
    first = last;
  }
}

}  // namespace

TriangleMesh compact(const Relief& relief, const StepSquares* steps, NodeMesh&& nodes,
                     int threads) {
  const Numbering numbering(nodes.used());
  TriangleMesh mesh;
  mesh.triangles = nodes.take_triangles();
  mesh.positions_mm.resize(numbering.count());
  parallel_parts(numbering.words(), kLeastTriangles / 8, threads,
                 [&](std::size_t begin, std::size_t end) {
                   for_each_used(numbering, begin, end, [&](NodeKey key, std::uint32_t index) {
                     mesh.positions_mm[index] = steps != nullptr && steps->is_own(key)
                                                    ? steps->position_mm(key)
                                                    : relief.position_mm(key);
                   });
                 });
  parallel_parts(mesh.triangles.size(), kLeastTriangles, threads,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t t = begin; t < end; ++t) {
                     for (std::uint32_t& corner : mesh.triangles[t]) {
                       corner = numbering.index(corner);
                     }
                   }
                 });
  if (relief.has_holes() && steps == nullptr) {
    std::vector<bool> is_shared(numbering.count());
    for_each_used(numbering, 0, numbering.words(), [&](NodeKey key, std::uint32_t index) {
      is_shared[index] = relief.at_hole(key);
    });
    split_fans(mesh, is_shared);
  }
  return mesh;
}

}  // namespace kerf
