// stock/octree/brick_finder.h - the bricks of a tree that a sweep comes near.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "stock/octree/brick_tree.h"
#include "stock/octree/sweep_kernel.h"

namespace kerf::octree {

/// Buffers only; one for each thread. What is empty, and what is far, costs a look at its tile.
class BrickFinder {
 public:
  BrickFinder(const BrickTree& tree, const SweepKernel& kernel);

  /// Calls visit(bx, by, bz, brick, low_mm) for each brick with material that may be nearer to the
  /// sweep than `within_mm`: nothing of it is nearer than low_mm, which is less than that.
  /// visit() may lessen `within_mm`.
  template <class Visit>
  void find(const Sweep& sweep, double& within_mm, const Visit& visit) {
    list_tiles(sweep, within_mm);
    for (const Place& tile : tiles_) {
      if (tile.low_mm >= within_mm) continue;
      list_bricks(sweep, tile, within_mm);
      for (const Place& at : bricks_)
        if (at.low_mm < within_mm)
          visit(at.x, at.y, at.z, tree_.brick(at.x, at.y, at.z), at.low_mm);
    }
  }

 private:
  struct Place {
    int x, y, z;
    double low_mm;
  };
  void list_tiles(const Sweep& sweep, double within_mm);
  void list_bricks(const Sweep& sweep, const Place& tile, double within_mm);
  /// Sets low_mm of those whose size along each axis is `nodes`; drops what is not near.
  void keep_near(const Sweep& sweep, int nodes, double within_mm, std::vector<Place>& places);

  const BrickTree& tree_;
  SweepKernel kernel_;
  std::vector<Place> tiles_, bricks_;
  std::vector<double> x_, y_, z_, f_;
};

}  // namespace kerf::octree
