// stock/octree/turned_tree.h - a tree as it lies elsewhere, axes on axes.
#pragma once

#include "base/placement.h"
#include "base/worker_pool.h"
#include "stock/octree/brick_tree.h"

namespace kerf::octree {

/// Nodes change places and with them what their edges hold; nothing is rounded but a crossing at an
/// edge's very end, by a part of 1 / kEdgeParts, and normals by what packing them costs. Without
/// ids, and as if sweeps had come near everywhere. Cost: what the surface passes.
BrickTree turned_tree(const BrickTree& tree, const AxisTurn& turn, const Vec3& at_mm,
                      WorkerPool& pool);

}  // namespace kerf::octree
