// stock/zmap/height_mesh_rim.h - what lies between the outer cell centres and the edge of the grid.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "stock/zmap/height_mesh_relief.h"
#include "stock/zmap/height_mesh_steps.h"

namespace kerf {

/// Triangles by node, and which nodes they use.
class NodeMesh {
 public:
  explicit NodeMesh(std::size_t key_count) : used_((key_count + 63) / 64, 0) {}

  void add(const NodeTriangle& triangle) {
    triangles_.push_back(triangle);
    mark(triangle);
  }
  void add(std::vector<NodeTriangle>&& more);
  bool uses(NodeKey key) const { return (used_[key / 64] >> (key % 64) & 1) != 0; }
  const std::vector<NodeTriangle>& triangles() const { return triangles_; }
  std::vector<NodeTriangle> take_triangles() { return std::move(triangles_); }
  /// One bit per key.
  const std::vector<std::uint64_t>& used() const { return used_; }

 private:
  void mark(const NodeTriangle& triangle) {
    for (const NodeKey key : triangle) used_[key / 64] |= std::uint64_t{1} << (key % 64);
  }
  std::vector<NodeTriangle> triangles_;
  std::vector<std::uint64_t> used_;
};

/// Adds the half cells between the outer cell centres that the mesh uses and the edge of the grid:
/// to the surface, or to the floor; but not what `steps` (which may be null) has divided.
void add_border(const Relief& relief, const StepSquares* steps, bool on_floor, NodeMesh& mesh);

/// Adds the walls between the nodes of the surface and those of the floor on the edge of the grid.
/// The mesh must hold both, edge included.
void add_walls(const Relief& relief, const StepSquares* steps, NodeMesh& mesh);

/// Divides the area between two chains of points, both from left to right, `upper` nowhere below
/// `lower`; at each end they share a point or stand above each other. Triangles counter-clockwise,
/// x to the right and z up; none without area. Each edge of the chains is in one triangle.
/// Source: M. Garey, D. Johnson, F. Preparata, R. Tarjan, "Triangulating a simple polygon",
/// Information Processing Letters 7, 1978.
struct ChainPoint {
  double x_mm;
  double z_mm;
  NodeKey key;
};
std::vector<NodeTriangle> triangulate_between(const std::vector<ChainPoint>& lower,
                                              const std::vector<ChainPoint>& upper);

}  // namespace kerf
