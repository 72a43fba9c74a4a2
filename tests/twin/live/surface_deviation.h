// tests/twin/live/surface_deviation.h - how far two workpieces are from each other.
#pragma once

#include <algorithm>
#include <cmath>

#include "stock/octree/octree.h"
#include "twin/compare/triangle_tree.h"

namespace kerf {

/// Farthest that a corner of either surface is from the other. mm.
inline double surface_deviation_mm(const Octree& a, const Octree& b) {
  const TriangleMesh one = a.mesh(1e-4);
  const TriangleMesh other = b.mesh(1e-4);
  const TriangleTree tree_one(one), tree_other(other);
  double worst = 0;
  for (const auto& p : one.positions_mm) {
    worst = std::max(worst, tree_other.nearest(Vec3(p)).distance2_mm2);
  }
  for (const auto& p : other.positions_mm) {
    worst = std::max(worst, tree_one.nearest(Vec3(p)).distance2_mm2);
  }
  return std::sqrt(worst);
}

}  // namespace kerf
