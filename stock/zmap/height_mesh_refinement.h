// stock/zmap/height_mesh_refinement.h - which cell centres a surface within a tolerance needs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stock/zmap/height_mesh_relief.h"
#include "stock/zmap/height_mesh_steps.h"

namespace kerf {

/// A right-triangulated network over the cell centres. The square of 2^k x 2^k steps that covers
/// the grid is halved along its diagonal, and each triangle is halved again from its right angle to
/// the middle of its longest edge:
///
///      D-------C      D-------C      D-------C      s: edge of a square, a power of two
///      |     / |      | \   / |      | \ | / |      C-A is split at the square's centre,
///      |   /   |  ->  |   c   |  ->  e---c---e      then D-A at the middle e of an edge,
///      | /     |      | /   \ |      | / | \ |      then the four squares of edge s / 2.
///      A-------B      A-------B      A-------B
///
/// Both triangles at an edge are split together, so the network has no cracks. Each splitting point
/// has an error: an upper bound of how far the surface of the unsplit triangles at that edge is
/// from that of all cells. A triangle is split where the error exceeds the limit.
///
/// Nodes beyond the grid are drawn back onto its edge ("clamped"). A triangle that crosses the edge
/// of the grid becomes narrower and may flip no corner, as columns keep their order; one that lies
/// beyond has no area and is left out; all of its corners are on the edge, where it leaves no gap.
///
/// After W. Evans, D. Kirkpatrick, G. Townsend, "Right-triangulated irregular networks",
/// Algorithmica 30 (2001), with errors measured where the sum of the bounds exceeds the limit.
class Refinement {
 public:
  /// relief: alternating, at least two cells wide and deep; must outlive this. Memory: one float
  /// per cell.
  /// What `steps` (which may be null) has divided is left out; of the floor, what is open.
  Refinement(const Relief& relief, const StepSquares* steps, double tolerance_mm, int threads);

  /// The surface over the cell centres, in single triangles, counter-clockwise from above; those
  /// wholly on the floor are left out.
  std::vector<NodeTriangle> surface() const;
  /// The floor beneath it, as few triangles as meet the surface at all edges of holes; seen from
  /// above as well.
  std::vector<NodeTriangle> floor() const;

 private:
  struct Node {
    int u;  ///< column of the covering square; cell column, if there is one
    int v;
  };
  struct Triangle {
    Node a, b;  ///< ends of the longest edge
    Node c;     ///< right angle; a, b, c counter-clockwise
  };
  struct Row;  // what one row of errors reads

  int column(int u) const { return std::min(u, nx_ - 1); }
  int row(int v) const { return std::min(v, ny_ - 1); }
  const float* heights(int v) const { return cells_ + std::size_t(row(v)) * std::size_t(nx_); }
  float* errors(int v) { return errors_.data() + row_slot_[std::size_t(v)] * stride_; }
  float error(Node n) const {
    return errors_[row_slot_[std::size_t(n.v)] * stride_ + column_slot_[std::size_t(n.u)]];
  }

  void keep_cells_around_holes();
  void keep_cells_around_steps();
  bool is_elsewhere(const Triangle& t, bool on_floor) const;
  void measure_level(int s, int threads);
  void measure_edges_along_x(int s, int v0);
  void measure_edges_along_y(int s, int v0);
  void measure_centres(int s, int v0);
  float settle(float delta, float below, bool measurable, auto&& measure) const;
  float measure_edge_along_x(int s, int u0, int v0) const;
  float measure_edge_along_y(int s, int u0, int v0) const;
  float measure_square(int s, int u0, int v0) const;
  float centre_delta(int s, int u0, int v0) const;
  float row_deviation(const float* h, int count, float start, float slope) const;

  bool is_beyond(const Triangle& t) const;
  bool is_split(const Triangle& t, float limit) const;
  std::vector<NodeTriangle> extract(float limit, bool on_floor) const;
  void extract_below(const Triangle& t, float limit, bool on_floor,
                     std::vector<NodeTriangle>& out) const;
  void emit(const Triangle& t, bool on_floor, std::vector<NodeTriangle>& out) const;

  const Relief& relief_;
  const StepSquares* steps_squares_;
  const float* cells_;
  int nx_;
  int ny_;
  int threads_;
  int steps_ = 1;  ///< edge of the covering square, a power of two
  float limit_mm_;
  /// Errors by slot: as many rows and columns as cells, and a few for the columns (rows) beyond the
  /// grid that belong to squares which cross its edge.
  std::vector<float> errors_;
  std::vector<float> no_errors_;  ///< a row of zeros, where there are no squares below
  std::vector<std::size_t> column_slot_;
  std::vector<std::size_t> row_slot_;
  std::size_t stride_ = 0;
};

}  // namespace kerf
