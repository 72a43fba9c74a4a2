// stock/octree/part_points.h - points of material, and sweeps over them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stock/octree/brick_tree.h"
#include "stock/octree/sweep_kernel.h"

namespace kerf::octree {

/// Coordinates in three rows, with room behind them for the kernels.
class PartPoints {
 public:
  PartPoints() { clear(); }
  void clear();
  void add(const Vec3& point_mm);
  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  Vec3 at(std::size_t n) const { return {x_[n], y_[n], z_[n]}; }
  const double* x() const { return x_.data(); }
  const double* y() const { return y_.data(); }
  const double* z() const { return z_.data(); }

 private:
  std::size_t count_ = 0;
  std::vector<double> x_, y_, z_;  ///< kLanes longer than count_
};

/// The least F of all sweeps at each point; infinity without a sweep. `f` has room behind, too.
void field_of(const SweepKernel& kernel, std::span<const Sweep> sweeps, const PartPoints& points,
              std::vector<double>& f);

/// The places where the surface crosses edges of this brick.
void add_crossings(const BrickTree& tree, int bx, int by, int bz, PartPoints& points);
/// And its solid nodes; one of a brick that is all solid.
void add_material(const BrickTree& tree, int bx, int by, int bz, PartPoints& points);

}  // namespace kerf::octree
