// stock/zmap/height_mesh_relief.h - the grid as the mesher sees it: a lattice of nodes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stock/zmap/height_mesh.h"

namespace kerf {

/// A corner of the mesh before it has an index: the number of its lattice node, plus node_count()
/// if it lies on the floor.
using NodeKey = std::uint32_t;
using NodeTriangle = std::array<NodeKey, 3>;

/// Cells, and around them the lattice of (nx + 2) x (ny + 2) nodes: node (i, j) is the centre of
/// cell (i - 1, j - 1), the outermost nodes lie on the edge of the grid and have the height of the
/// cell next to them.
///
///     j=2  o-o---o---o-o      nx = 3, ny = 1
///     j=1  o-c---c---c-o      c cell centre
///     j=0  o-o---o---o-o
///        i=0 1   2   3 4
class Relief {
 public:
  /// alternating: the diagonals of the squares between cell centres alternate like a chequerboard
  /// (as bisection makes them); else all go from low x, y to high x, y. With alternating a grid one
  /// cell wide becomes two half cells wide (the same surface), so that there are squares.
  Relief(const CellHeights& grid, bool alternating);
  /// Walls are where they stand (height_mesh_steps.h); so no hole is too narrow.
  bool has_steps() const { return has_steps_; }

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  int width() const { return nx_ + 2; }   ///< nodes in x
  int height() const { return ny_ + 2; }  ///< nodes in y
  std::size_t node_count() const { return std::size_t(width()) * std::size_t(height()); }
  double x_mm(int i) const { return x_mm_[std::size_t(i)]; }
  double y_mm(int j) const { return y_mm_[std::size_t(j)]; }
  float floor_mm() const { return floor_mm_; }
  float greatest_magnitude_mm() const { return greatest_magnitude_mm_; }

  bool has_holes() const { return has_holes_; }
  bool has_material() const { return has_material_; }
  /// Heights of the cells, row by row, none below the floor.
  const float* cells_mm() const { return cells_mm_.data(); }
  bool cell_is_solid(int ci, int cj) const { return cells_mm_[cell(ci, cj)] > floor_mm_; }

  float node_mm(int i, int j) const { return cells_mm_[cell_of_node(i, j)]; }
  bool node_is_solid(int i, int j) const { return node_mm(i, j) > floor_mm_; }

  /// Node (i, j) of the surface. Without material this is the floor's key: the two meet there.
  NodeKey top_key(int i, int j) const {
    return node_is_solid(i, j) ? number(i, j) : floor_key(i, j);
  }
  NodeKey floor_key(int i, int j) const { return number(i, j) + NodeKey(node_count()); }
  bool on_floor(NodeKey key) const { return key >= node_count(); }
  glm::vec3 position_mm(NodeKey key) const;
  /// True for corners where surface and floor meet along the edge of a hole.
  bool at_hole(NodeKey key) const;

 private:
  std::size_t cell(int ci, int cj) const {
    return std::size_t(cj) * std::size_t(nx_) + std::size_t(ci);
  }
  std::size_t cell_of_node(int i, int j) const {
    return cell(std::clamp(i - 1, 0, nx_ - 1), std::clamp(j - 1, 0, ny_ - 1));
  }
  NodeKey number(int i, int j) const { return NodeKey(j) * NodeKey(width()) + NodeKey(i); }

  struct Node {
    int i;
    int j;
  };
  void take_cells(const CellHeights& grid, int repeat_x, int repeat_y);
  void close_narrow_holes();
  void visit_hole_cell(std::size_t start, std::vector<std::size_t>& pending);
  bool find_touching_edge(int ci, int cj, std::size_t& other) const;
  bool touches_itself(Node a, Node b) const;
  bool is_edge(Node a, int di, int dj) const;
  bool diagonal_rises(int i, int j) const;
  bool is_solid_node(Node n) const;
  int count_hole_neighbours(std::size_t cell) const;

  int nx_ = 0;
  int ny_ = 0;
  bool alternating_ = false;
  bool has_steps_ = false;
  bool has_holes_ = false;
  bool has_material_ = false;
  float floor_mm_ = 0.0f;
  float greatest_magnitude_mm_ = 0.0f;
  std::span<const float> cells_mm_;
  std::vector<float> own_cells_mm_;  // only where the caller's could not be used as they are
  std::vector<double> x_mm_;
  std::vector<double> y_mm_;
};

}  // namespace kerf
