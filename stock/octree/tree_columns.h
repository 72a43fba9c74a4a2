// stock/octree/tree_columns.h - the nodes of a tile as columns.
#pragma once

#include "stock/column_runs.h"
#include "stock/octree/brick_tree.h"

namespace kerf::octree {

ColumnLayout column_layout_of(const Lattice& lattice);
/// Runs end where the vertical edges are crossed.
void read_columns(const BrickTree& tree, std::uint32_t tile, ColumnRuns& out);

}  // namespace kerf::octree
