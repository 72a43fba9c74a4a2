#include "stock/octree/turned_tree.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>

#include "stock/octree/hermite_gather.h"
#include "stock/octree/hermite_grid.h"

namespace kerf::octree {
namespace {

std::size_t at(int axis) { return static_cast<std::size_t>(axis); }

Lattice turned_lattice(const Lattice& was, const AxisTurn& turn, const Vec3& at_mm) {
  Box box;
  std::array<int, 3> cells{};
  for (int axis = 0; axis < 3; ++axis) {
    const int from = turn.from[at(axis)], sign = turn.sign[at(axis)];
    const double a = sign * was.bounds_mm.min[from] + at_mm[axis];
    const double b = sign * was.bounds_mm.max[from] + at_mm[axis];
    box.min[axis] = std::min(a, b);
    box.max[axis] = std::max(a, b);
    cells[at(axis)] = was.cells[at(from)];
  }
  return Lattice::of_cells(box, cells);
}

/// Fills the new tree brick by brick, each from the nodes of the old one that lie in it.
class TreeTurner {
 public:
  TreeTurner(const BrickTree& was, const AxisTurn& turn) : was_(was), turn_(turn) {}

  /// Of the old nodes of `count` new ones from `first` on along each axis the lowest, by old axes.
  std::array<int, 3> first_was(const std::array<int, 3>& first, int count) const {
    std::array<int, 3> out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t from = at(turn_.from[axis]);
      out[from] = turn_.sign[axis] > 0 ? first[axis]
                                       : was_.lattice().cells[from] + 1 - (first[axis] + count - 1);
    }
    return out;
  }

  /// What all of the tile's nodes are, the layer beyond as well; null: they differ.
  const TileRef* uniform(const std::array<int, 3>& first_new) const {
    const Lattice& lattice = was_.lattice();
    const std::array<int, 3> low = first_was(first_new, kTileNodes + 1);
    const TileRef* found = nullptr;
    for (unsigned n = 0; n < 8; ++n) {
      std::array<int, 3> tile{};
      for (std::size_t a = 0; a < 3; ++a) {
        const int node = low[a] + ((n >> a & 1u) != 0 ? kTileNodes : 0);
        tile[a] = node < 0 ? -1 : node / kTileNodes;
        if (tile[a] < 0 || tile[a] >= lattice.tiles[a]) return nullptr;
      }
      const TileRef& ref = was_.tile(tile[1] * lattice.tiles[0] + tile[0], tile[2]);
      if (ref.get() || (found && ref.is_solid() != found->is_solid())) return nullptr;
      found = &ref;
    }
    return found;
  }

  BrickRef make(const std::array<int, 3>& first_new) {
    gather(was_, false, first_was(first_new, kSide), {kSide, kSide, kSide}, &grid_);
    if (grid_.crossings.empty()) {
      // Of nodes that all are alike; where there is a surface there are crossings.
      return grid_.solid.front() != 0 ? BrickRef::solid() : BrickRef();
    }
    open_->open(BrickRef());
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        unsigned column = 0;
        for (int k = 0; k < kSide; ++k) column |= unsigned{grid_.solid[number_was({i, j, k})]} << k;
        open_->columns[j * kSide + i] = static_cast<std::uint16_t>(column);
      }
    }
    for_each_crossed(open_->columns,
                     [&](int axis, int i, int j, int k) { turn_edge(axis, i, j, k); });
    open_->measure();
    return open_->close(false);
  }

 private:
  /// In grid_, of a node of the new brick.
  std::size_t number_was(const std::array<int, 3>& node) const {
    std::array<int, 3> was{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      was[at(turn_.from[axis])] = turn_.sign[axis] > 0 ? node[axis] : kBrick - node[axis];
    return static_cast<std::size_t>((was[2] * kSide + was[1]) * kSide + was[0]);
  }

  void turn_edge(int axis, int i, int j, int k) {
    std::array<int, 3> lower{i, j, k};
    const bool is_reversed = turn_.sign[at(axis)] < 0;
    if (is_reversed) ++lower[at(axis)];  // the old edge begins at the other end
    const std::int32_t n = grid_.edges[at(turn_.from[at(axis)])][number_was(lower)];
    const HermiteCrossing& crossing = grid_.crossings[static_cast<std::size_t>(n)];
    const auto place = static_cast<int>(crossing.t * kEdgeParts);
    glm::vec3 normal;
    for (int a = 0; a < 3; ++a)
      normal[a] = static_cast<float>(turn_.sign[at(a)]) * crossing.normal[turn_.from[at(a)]];
    const std::size_t e =
        static_cast<std::size_t>(axis * kBrickNodes + (j * kBrick + i) * kBrick + k);
    open_->place[e] = static_cast<std::uint16_t>(
        std::min(is_reversed ? kEdgeParts - place : place, kEdgeParts - 1));
    open_->direction[e] = pack_direction(normal);
  }

  const BrickTree& was_;
  AxisTurn turn_;
  HermiteGrid grid_;
  std::unique_ptr<OpenBrick> open_ = std::make_unique<OpenBrick>();
};

TileRef make_tile(TreeTurner& turner, const std::array<int, 3>& first, std::uint64_t version) {
  Tile* tile = new Tile;
  tile->version = version;
  for (int b = 0; b < kBricksInTile; ++b) {
    const std::array<int, 3> in_tile{b % kTileBricks, b / kTileBricks % kTileBricks,
                                     b / (kTileBricks * kTileBricks)};
    std::array<int, 3> node = first;
    for (std::size_t a = 0; a < 3; ++a) node[a] += in_tile[a] * kBrick;
    tile->bricks[b] = turner.make(node);
  }
  return TileRef::adopt(tile);
}

}  // namespace

BrickTree turned_tree(const BrickTree& tree, const AxisTurn& turn, const Vec3& at_mm,
                      WorkerPool& pool) {
  BrickTree out(turned_lattice(tree.lattice(), turn, at_mm));
  const Lattice& lattice = out.lattice();
  const std::uint64_t version = next_version();
  std::atomic<int> next{0};
  pool.run([&](int) {
    TreeTurner turner(tree, turn);
    for (int column = next++; column < lattice.column_count(); column = next++) {
      for (int level = 0; level < lattice.tiles[2]; ++level) {
        const std::array<int, 3> first{column % lattice.tiles[0] * kTileNodes,
                                       column / lattice.tiles[0] * kTileNodes, level * kTileNodes};
        const TileRef* const alike = turner.uniform(first);
        out.set_tile(column, level, alike ? *alike : make_tile(turner, first, version));
        out.settle_tile(column, level);
      }
    }
  });
  return out;
}

}  // namespace kerf::octree
