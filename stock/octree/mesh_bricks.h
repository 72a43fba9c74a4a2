// stock/octree/mesh_bricks.h - a tree that holds what a mesh encloses.
#pragma once

#include "base/worker_pool.h"
#include "mesh/mesh_body.h"
#include "stock/octree/brick_tree.h"

namespace kerf::octree {

/// Nodes are solid where lines along Z through them say so; crossings and normals are those of the
/// triangles that lines along the edges meet. `tree` is empty before. What of the mesh is thinner
/// than a cell may vanish. Beside the tree some 24 bytes a crossing, and 8 a line.
void fill_mesh(BrickTree& tree, const MeshBody& body, WorkerPool& pool);

}  // namespace kerf::octree
