// stock/octree/brick.h - 8 x 8 x 8 nodes with the crossings of their edges.
//
//   A brick owns 8 nodes along each axis and the edges from them to their upper neighbours. It also
//   holds the state of the neighbours one layer beyond, so that it can be cut by itself.
//
//      o--o--o--o--o--o--o--o--+     o own nodes, + the layer beyond; -- edges
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "base/mesh_patch.h"
#include "stock/octree/sparse_ref.h"

namespace kerf::octree {

inline constexpr int kBrick = 8;          ///< own nodes along an axis
inline constexpr int kSide = kBrick + 1;  ///< with the layer beyond
inline constexpr int kBrickNodes = kBrick * kBrick * kBrick;
inline constexpr std::uint16_t kFullColumn = 0x1ff;

/// Parts of an edge, of which a crossing's place is a whole number.
inline constexpr int kEdgeParts = 65536;
/// Volume of the box around one node, as sums of volume count it.
inline constexpr std::int32_t kNodeVolume = 3 << 19;

/// Unit vector in 2 x 16 bits (octahedron), 0.005 degrees fine.
std::uint32_t pack_direction(const glm::vec3& unit);
glm::vec3 unpack_direction(std::uint32_t packed);

/// A brick as it is kept. Crossings are in the order of their edges: by axis, then node.
struct Brick : Counted {
  std::uint16_t columns[kSide * kSide];  ///< [j * kSide + i], bit k: node (i, j, k) is solid
  std::uint16_t crossings = 0;
  bool has_ids = false;
  std::int64_t volume = 0;  ///< as OpenBrick::volume

  const std::uint32_t* directions() const {
    return reinterpret_cast<const std::uint32_t*>(this + 1);
  }
  const std::uint32_t* ids() const { return directions() + crossings; }
  const std::uint16_t* places() const {
    return reinterpret_cast<const std::uint16_t*>(directions() +
                                                  (has_ids ? 2 : 1) * std::size_t{crossings});
  }
  std::size_t bytes() const {
    return sizeof(Brick) + crossings * (has_ids ? std::size_t{10} : std::size_t{6});
  }
  static Brick* allocate(int crossings, bool ids);
  static void destroy(Brick* brick);
  bool same_surface(const Brick& other) const;
};
using BrickRef = SparseRef<Brick>;

/// A brick to be changed: every edge has its place.
struct OpenBrick {
  std::uint16_t columns[kSide * kSide];
  // By edge: axis * kBrickNodes + node, where node = (j * kBrick + i) * kBrick + k. Only those of
  // crossed edges mean something.
  std::uint16_t place[3 * kBrickNodes];      ///< from the lower node, in kEdgeParts
  std::uint32_t direction[3 * kBrickNodes];  ///< out of the material, packed
  std::uint32_t id[3 * kBrickNodes];         ///< unused where ids are not kept
  /// What the crossing adds to the volume, in kNodeVolume: nodes count as the boxes around them,
  /// and planes are exact but for their ends.
  std::int32_t share[3 * kBrickNodes];
  std::int64_t volume = 0;                  ///< of solid own nodes and of all shares
  std::int32_t height_of[kBrick * kBrick];  ///< solid length of a column, in kEdgeParts an edge
  /// Height of the highest solid node above node 0, in nodes; -1: none.
  int top_node = -1;
  bool top_is_known = false;

  void open(const BrickRef& brick);
  /// Empty or solid where it is.
  BrickRef close(bool with_ids) const;

  /// Crossed edges along `axis` from the own nodes of column (i, j).
  unsigned crossed(int axis, int i, int j) const {
    const unsigned c = columns[j * kSide + i];
    const unsigned next = axis == 0   ? columns[j * kSide + i + 1]
                          : axis == 1 ? columns[(j + 1) * kSide + i]
                                      : c >> 1;
    return (c ^ next) & 0xffu;
  }
  /// Anew from columns and crossings: shares, volume, heights and top_node.
  void measure();
  /// Height of the highest material known here, in kEdgeParts an edge.
  int top();

 private:
  int top_ = 0;
};

/// Calls visit(axis, i, j, k) for each crossed edge, in the order in which they are kept.
template <class Visit>
void for_each_crossed(const std::uint16_t* columns, const Visit& visit) {
  for (int axis = 0; axis < 3; ++axis) {
    const int step = axis == 0 ? 1 : axis == 1 ? kSide : 0;
    for (int j = 0; j < kBrick; ++j) {
      for (int i = 0; i < kBrick; ++i) {
        const unsigned c = columns[j * kSide + i];
        const unsigned next = axis == 2 ? c >> 1 : columns[j * kSide + i + step];
        for (unsigned bits = (c ^ next) & 0xffu; bits != 0; bits &= bits - 1)
          visit(axis, i, j, std::countr_zero(bits));
      }
    }
  }
}

}  // namespace kerf::octree
