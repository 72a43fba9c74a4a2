#include "stock/octree/hermite_gather.h"

#include <algorithm>

namespace kerf::octree {
namespace {

/// Copies one brick's share.
struct BrickGatherer {
  const BrickTree& tree;
  bool complement;
  const std::array<int, 3>& first;
  const std::array<int, 3>& nodes;
  HermiteGrid& grid;

  std::size_t number(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(nodes[1]) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(nodes[0]) +
           static_cast<std::size_t>(i);
  }

  void copy(int bx, int by, int bz) const {
    const BrickRef& brick = tree.brick(bx, by, bz);
    const int origin[3] = {bx * kBrick - first[0], by * kBrick - first[1], bz * kBrick - first[2]};
    int low[3], high[3];
    for (int a = 0; a < 3; ++a) {
      low[a] = std::max(0, -origin[a]);
      high[a] = std::min(kBrick, nodes[static_cast<std::size_t>(a)] - origin[a]);
    }
    if (!brick.get() && brick.is_solid() == complement) return;
    for (int j = low[1]; j < high[1]; ++j) {
      for (int i = low[0]; i < high[0]; ++i) {
        unsigned column = brick.get() ? brick->columns[j * kSide + i] : kFullColumn;
        if (complement) column = brick.get() ? ~column : kFullColumn;
        for (int k = low[2]; k < high[2]; ++k)
          grid.solid[number(origin[0] + i, origin[1] + j, origin[2] + k)] =
              static_cast<std::uint8_t>(column >> k & 1u);
      }
    }
    if (brick.get()) copy_crossings(*brick.get(), origin, low, high);
  }

  void copy_crossings(const Brick& brick, const int origin[3], const int low[3],
                      const int high[3]) const {
    std::size_t next = 0;
    for_each_crossed(brick.columns, [&](int axis, int i, int j, int k) {
      const std::size_t n = next++;
      const int at[3] = {i, j, k};
      for (int a = 0; a < 3; ++a)
        if (at[a] < low[a] || at[a] >= high[a]) return;
      if (origin[axis] + at[axis] + 1 >= nodes[static_cast<std::size_t>(axis)]) return;
      HermiteCrossing crossing;
      crossing.t = static_cast<float>(brick.places()[n]) / kEdgeParts;
      crossing.normal = unpack_direction(brick.directions()[n]);
      if (complement) crossing.normal = -crossing.normal;
      if (brick.has_ids) crossing.cut_by = brick.ids()[n];
      grid.edges[static_cast<std::size_t>(axis)]
                [number(origin[0] + i, origin[1] + j, origin[2] + k)] =
          static_cast<std::int32_t>(grid.crossings.size());
      grid.crossings.push_back(crossing);
    });
  }
};

int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

}  // namespace

void gather(const BrickTree& tree, bool complement, const std::array<int, 3>& first,
            const std::array<int, 3>& nodes, HermiteGrid* grid) {
  const Lattice& lattice = tree.lattice();
  grid->nodes = nodes;
  grid->cell_mm = lattice.cell_mm;
  std::size_t count = 1;
  std::array<int, 3> low{}, high{};
  for (std::size_t a = 0; a < 3; ++a) {
    grid->origin_mm[static_cast<int>(a)] = lattice.place_mm(static_cast<int>(a), first[a]);
    count *= static_cast<std::size_t>(nodes[a]);
    low[a] = std::max(0, floor_div(first[a], kBrick));
    high[a] =
        std::min(lattice.tiles[a] * kTileBricks - 1, floor_div(first[a] + nodes[a] - 1, kBrick));
  }
  grid->solid.assign(count, 0);
  for (std::vector<std::int32_t>& edges : grid->edges) edges.assign(count, -1);
  grid->crossings.clear();
  const BrickGatherer gatherer{tree, complement, first, nodes, *grid};
  for (int bz = low[2]; bz <= high[2]; ++bz)
    for (int by = low[1]; by <= high[1]; ++by)
      for (int bx = low[0]; bx <= high[0]; ++bx) gatherer.copy(bx, by, bz);
}

}  // namespace kerf::octree
