// stock/octree/mesh_bricks.h - a tree that holds what a closed mesh encloses.
#pragma once

#include "base/triangle_mesh.h"
#include "base/worker_pool.h"
#include "stock/octree/brick_tree.h"

namespace kerf::octree {

/// Nodes are solid where lines along Z through them say so; crossings and normals are those of the
/// triangles that lines along the edges meet (mesh/mesh_lines.h). So faces keep their places and
/// edges between faces stay sharp. `tree` is empty before. Beside the tree some 24 bytes a
/// crossing, and 8 a line, three times over.
///
/// What is known of it: whatever the tree takes for solid and the mesh does not hold, or the other
/// way about, lies within a cell's diagonal of the mesh. For each node is as the
/// mesh has it, and a cell that the mesh does not enter has eight nodes that are alike, whose cell
/// is all that they are; what is told wrongly lies in a cell that the mesh enters, and no two
/// points of a cell are farther apart than its diagonal. On a plane that fills a cell and those
/// about it, crossings are exact to 1 / kEdgeParts. The other way about there is no such bound:
/// what of the mesh is thinner than a cell may lie between nodes and vanish, however long it is.
void fill_mesh(BrickTree& tree, const TriangleMesh& mesh, WorkerPool& pool);

}  // namespace kerf::octree
