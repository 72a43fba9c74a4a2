// stock/octree/hermite_grid.h - a piece of a closed surface, sampled for dual contouring.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "base/geometry.h"

namespace kerf {

/// Where the surface crosses the edge between two neighbouring nodes, one of which is solid.
struct HermiteCrossing {
  float t = 0;                         ///< 0 at the lower node, 1 at the upper one
  glm::vec3 normal{0};                 ///< unit, out of the material
  std::uint32_t cut_by = 0xffff'ffff;  ///< CutMove::id; MeshPatch::kNotCut on the blank's surface
};

/// A box of nodes, x fastest: node (i, j, k) is number (k * nodes[1] + j) * nodes[0] + i and lies
/// at origin_mm + (i, j, k) * cell_mm. The cell (i, j, k) has that node as its lowest corner.
///
/// An edge has a crossing exactly if one of its nodes is solid and the other is not. Of a surface
/// that crosses an edge several times only an odd number of times shows, as one crossing.
struct HermiteGrid {
  std::array<int, 3> nodes{};
  Vec3 origin_mm{0};
  Vec3 cell_mm{0};
  std::vector<std::uint8_t> solid;  ///< 0 or 1 a node
  /// For each axis and node: number in `crossings` of the crossing on the edge from that node to
  /// the next one along the axis; -1 for none, and for nodes without a next one.
  std::array<std::vector<std::int32_t>, 3> edges;
  std::vector<HermiteCrossing> crossings;
};

}  // namespace kerf
