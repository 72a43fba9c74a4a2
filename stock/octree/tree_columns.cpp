#include "stock/octree/tree_columns.h"

#include <array>
#include <bit>

namespace kerf::octree {
namespace {

constexpr int kTileColumns = kTileNodes * kTileNodes;

/// What is asked of bricks that lie above each other: solid nodes, and crossings of vertical edges.
struct Stack {
  /// One more below: whose uppermost nodes and edges count.
  std::array<const BrickRef*, kTileBricks + 1> bricks{};
  /// By brick, column and node: from the lower node, in kEdgeParts.
  std::uint16_t places[kTileBricks + 1][kBrick * kBrick][kBrick];

  void read(int n) {
    const Brick* const brick = bricks[static_cast<std::size_t>(n)]->get();
    if (brick == nullptr) return;
    std::size_t next = 0;
    for_each_crossed(brick->columns, [&](int axis, int i, int j, int k) {
      const std::size_t at = next++;
      if (axis == 2) places[n][j * kBrick + i][k] = brick->places()[at];
    });
  }
  unsigned nodes(int n, int i, int j) const {
    const BrickRef& brick = *bricks[static_cast<std::size_t>(n)];
    if (brick.get()) return brick->columns[j * kSide + i] & 0xffu;
    return brick.is_solid() ? 0xffu : 0u;
  }
  /// Part of the edge from a node upward (-1: the last one below the tile) to its crossing.
  double place(int node, int i, int j) const {
    const int n = (node + kBrick) / kBrick, k = (node + kBrick) % kBrick;
    constexpr double kMiddle = 0.5;
    if (bricks[static_cast<std::size_t>(n)]->get() == nullptr) return kMiddle;
    return static_cast<double>(places[n][j * kBrick + i][k]) / kEdgeParts;
  }
};

}  // namespace

ColumnLayout column_layout_of(const Lattice& lattice) {
  const Vec2 cell(lattice.cell_mm);
  return {Vec2(lattice.origin_mm) - cell / 2.0,
          cell,
          lattice.tiles,
          {kTileNodes, kTileNodes},
          lattice.cell_mm.z};
}

void read_columns(const BrickTree& tree, std::uint32_t number, ColumnRuns& out) {
  const Lattice& lattice = tree.lattice();
  const std::array<int, 3> at = lattice.tile_at(number);
  out.nx = out.ny = kTileNodes;
  out.runs.clear();
  out.first.assign(kTileColumns + 1, 0);
  const int first_node = at[2] * kTileNodes;
  const auto z = [&](double node) {
    return static_cast<float>(lattice.origin_mm.z + (first_node + node) * lattice.cell_mm.z);
  };
  const bool is_empty = tree.tile(number).is_empty();
  // Columns are in the order of rows, stacks of bricks are not: by rows of stacks.
  std::array<Stack, kTileBricks> stacks;
  for (int by = 0; by < kTileBricks; ++by) {
    for (int bx = 0; bx < kTileBricks && !is_empty; ++bx) {
      Stack& stack = stacks[static_cast<std::size_t>(bx)];
      for (int n = 0; n <= kTileBricks; ++n) {
        stack.bricks[static_cast<std::size_t>(n)] = &tree.brick(
            at[0] * kTileBricks + bx, at[1] * kTileBricks + by, at[2] * kTileBricks + n - 1);
        stack.read(n);
      }
    }
    for (int row = 0; row < kTileNodes * kBrick; ++row) {
      const int x = row % kTileNodes, j = row / kTileNodes, i = x % kBrick;
      const std::size_t column = static_cast<std::size_t>((by * kBrick + j) * kTileNodes + x);
      out.first[column] = static_cast<std::uint32_t>(out.runs.size());
      if (is_empty) continue;
      const Stack& stack = stacks[static_cast<std::size_t>(x / kBrick)];
      std::uint64_t solid = 0;  // bit 0: the node below the tile
      for (int n = 1; n <= kTileBricks; ++n)
        solid |= std::uint64_t{stack.nodes(n, i, j)} << ((n - 1) * kBrick + 1);
      const bool goes_on_below = (stack.nodes(0, i, j) >> (kBrick - 1) & 1u) != 0;
      for (std::uint64_t left = solid; left != 0;) {
        const int low = std::countr_zero(left);
        const int high = low + std::countr_one(left >> low);  // beyond
        const int node = low - 1, beyond = high - 1;
        SolidRun run;
        run.low_mm = node == 0 && goes_on_below ? z(0) : z(node - 1 + stack.place(node - 1, i, j));
        bool goes_on_above = false;
        if (beyond == kTileNodes) {
          const BrickRef& above = tree.brick(at[0] * kTileBricks + x / kBrick,
                                             at[1] * kTileBricks + by, (at[2] + 1) * kTileBricks);
          goes_on_above =
              above.get() ? (above->columns[j * kSide + i] & 1u) != 0 : above.is_solid();
        }
        // One that ends between here and the tile above ends below that one's first node.
        run.high_mm = goes_on_above ? z(kTileNodes) : z(beyond - 1 + stack.place(beyond - 1, i, j));
        out.runs.push_back(run);
        left &= ~((std::uint64_t{1} << high) - 1);
      }
    }
  }
  out.first[kTileColumns] = static_cast<std::uint32_t>(out.runs.size());
}

}  // namespace kerf::octree
