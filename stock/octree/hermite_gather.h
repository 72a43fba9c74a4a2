// stock/octree/hermite_gather.h - a box of a tree's nodes as a HermiteGrid.
#pragma once

#include <array>

#include "stock/octree/brick_tree.h"
#include "stock/octree/hermite_grid.h"

namespace kerf::octree {

/// `complement`: what the tree holds as empty is solid, within the blank (additive models).
void gather(const BrickTree& tree, bool complement, const std::array<int, 3>& first,
            const std::array<int, 3>& nodes, HermiteGrid* grid);

}  // namespace kerf::octree
