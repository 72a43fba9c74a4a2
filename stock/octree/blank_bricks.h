// stock/octree/blank_bricks.h - a tree that holds an uncut blank.
#pragma once

#include "base/worker_pool.h"
#include "stock/blank.h"
#include "stock/octree/brick_tree.h"

namespace kerf::octree {

/// The union of the blank's bodies; crossings and normals exact. Of a blank that is one box, bricks
/// and tiles that look alike are one in memory: it costs next to nothing, whatever the cell.
BrickTree blank_tree(const Lattice& lattice, const Blank& blank, WorkerPool& pool);

/// All solid, the nodes outside of the blank as well.
BrickTree solid_tree(const Lattice& lattice);

/// In kNodeVolume.
std::int64_t volume_of(const BrickTree& tree);

}  // namespace kerf::octree
