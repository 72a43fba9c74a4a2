#include "stock/zmap/height_mesh.h"

#include <cassert>
#include <optional>
#include <utility>

#include "stock/zmap/height_mesh_compact.h"
#include "stock/zmap/height_mesh_refinement.h"
#include "stock/zmap/height_mesh_relief.h"
#include "stock/zmap/height_mesh_rim.h"
#include "stock/zmap/height_mesh_steps.h"

namespace kerf {
namespace {

/// Every square of the lattice that has no steps, divided from low x, y to high x, y.
std::vector<NodeTriangle> full_surface(const Relief& relief, const StepSquares* steps) {
  std::vector<NodeTriangle> triangles;
  triangles.reserve(2 * relief.node_count());
  for (int j = 0; j + 1 < relief.height(); ++j) {
    for (int i = 0; i + 1 < relief.width(); ++i) {
      if (steps != nullptr && steps->is_divided(i, j)) continue;
      const NodeKey a = relief.top_key(i, j);
      const NodeKey b = relief.top_key(i + 1, j);
      const NodeKey c = relief.top_key(i + 1, j + 1);
      const NodeKey d = relief.top_key(i, j + 1);
      const bool diagonal_on_floor = relief.on_floor(a) && relief.on_floor(c);
      if (!diagonal_on_floor || !relief.on_floor(b)) triangles.push_back({a, b, c});
      if (!diagonal_on_floor || !relief.on_floor(d)) triangles.push_back({a, c, d});
    }
  }
  return triangles;
}

/// The surface's triangles on the floor, seen from below.
std::vector<NodeTriangle> floor_beneath(const Relief& relief,
                                        const std::vector<NodeTriangle>& surface) {
  const auto lowered = [&](NodeKey key) {
    return relief.on_floor(key) ? key : key + NodeKey(relief.node_count());
  };
  std::vector<NodeTriangle> floor;
  floor.reserve(surface.size());
  for (const auto& [a, b, c] : surface) floor.push_back({lowered(a), lowered(c), lowered(b)});
  return floor;
}

void add_plain_floor(const Relief& relief, NodeMesh& nodes) {
  const int i = relief.width() - 1;
  const int j = relief.height() - 1;
  const NodeKey a = relief.floor_key(0, 0);
  const NodeKey c = relief.floor_key(i, j);
  nodes.add(NodeTriangle{a, c, relief.floor_key(i, 0)});
  nodes.add(NodeTriangle{a, relief.floor_key(0, j), c});
}

/// The floor of squares that have steps and material all over.
std::vector<NodeTriangle> floor_beneath_steps(const Relief& relief, const StepSquares& steps) {
  std::vector<NodeTriangle> floor;
  for (int j = 0; j + 1 < relief.height(); ++j) {
    for (int i = 0; i + 1 < relief.width(); ++i) {
      if (!steps.is_divided(i, j) || steps.is_open(i, j)) continue;
      const NodeKey a = relief.floor_key(i, j), c = relief.floor_key(i + 1, j + 1);
      floor.push_back({a, c, relief.floor_key(i + 1, j)});
      floor.push_back({a, relief.floor_key(i, j + 1), c});
    }
  }
  return floor;
}

void add_all_cells(const Relief& relief, const StepSquares* steps, NodeMesh& nodes) {
  std::vector<NodeTriangle> surface = full_surface(relief, steps);
  if (!relief.has_holes()) {
    nodes.add(std::move(surface));
    return add_plain_floor(relief, nodes);
  }
  std::vector<NodeTriangle> floor = floor_beneath(relief, surface);
  nodes.add(std::move(surface));
  nodes.add(std::move(floor));
  if (steps != nullptr) nodes.add(floor_beneath_steps(relief, *steps));
}

void add_within_tolerance(const Relief& relief, const StepSquares* steps, double tolerance_mm,
                          int threads, NodeMesh& nodes) {
  const Refinement refinement(relief, steps, tolerance_mm, threads);
  nodes.add(refinement.surface());
  if (!relief.has_holes()) {
    add_border(relief, steps, false, nodes);
    add_plain_floor(relief, nodes);
    return;
  }
  std::vector<NodeTriangle> floor = refinement.floor();
  for (NodeTriangle& triangle : floor) std::swap(triangle[1], triangle[2]);
  nodes.add(std::move(floor));
  add_border(relief, steps, false, nodes);
  add_border(relief, steps, true, nodes);
}

}  // namespace

TriangleMesh mesh_height_grid(const CellHeights& grid, double tolerance_mm, int threads) {
  assert(threads >= 1);
  const bool all_cells = !(tolerance_mm > 0.0);
  const Relief relief(grid, !all_cells);
  if (!relief.has_material()) return {};
  std::optional<StepSquares> squares;
  std::vector<NodeTriangle> divided;
  if (relief.has_steps()) {
    squares.emplace(relief, *grid.steps);
    squares->add_surface(divided);
    if (relief.has_holes()) squares->add_floor(divided);
  }
  const StepSquares* const steps = squares ? &*squares : nullptr;
  NodeMesh nodes(steps != nullptr ? steps->key_count() : 2 * relief.node_count());
  // The border goes by which nodes are used.
  nodes.add(std::move(divided));
  if (all_cells) {
    add_all_cells(relief, steps, nodes);
  } else {
    add_within_tolerance(relief, steps, tolerance_mm, threads, nodes);
  }
  add_walls(relief, steps, nodes);
  return compact(relief, steps, std::move(nodes), threads);
}

}  // namespace kerf
