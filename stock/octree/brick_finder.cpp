#include "stock/octree/brick_finder.h"

namespace kerf::octree {

BrickFinder::BrickFinder(const BrickTree& tree, const SweepKernel& kernel)
    : tree_(tree), kernel_(kernel) {}

void BrickFinder::keep_near(const Sweep& sweep, int nodes, double within_mm,
                            std::vector<Place>& places) {
  const Lattice& lattice = tree_.lattice();
  // A brick holds the edges to the layer of nodes beyond: half of its diagonal reaches there.
  const double half_mm = 0.5 * nodes * glm::length(lattice.cell_mm);
  const std::size_t room = places.size() + kLanes;
  for (std::vector<double>* v : {&x_, &y_, &z_, &f_}) v->assign(room, 0.0);
  for (std::size_t n = 0; n < places.size(); ++n) {
    x_[n] = lattice.origin_mm.x + (places[n].x + 0.5) * nodes * lattice.cell_mm.x;
    y_[n] = lattice.origin_mm.y + (places[n].y + 0.5) * nodes * lattice.cell_mm.y;
    z_[n] = lattice.origin_mm.z + (places[n].z + 0.5) * nodes * lattice.cell_mm.z;
  }
  kernel_.distance(sweep, static_cast<int>(places.size()), x_.data(), y_.data(), z_.data(),
                   f_.data());
  std::size_t kept = 0;
  for (std::size_t n = 0; n < places.size(); ++n) {
    places[n].low_mm = f_[n] - half_mm - kSweepSlack_mm;
    if (places[n].low_mm < within_mm) places[kept++] = places[n];
  }
  places.resize(kept);
}

void BrickFinder::list_tiles(const Sweep& sweep, double within_mm) {
  const Lattice& lattice = tree_.lattice();
  int low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = lattice.cell_mm[axis] * kTileNodes;
    const double last = lattice.tiles[static_cast<std::size_t>(axis)] - 1;
    const double margin = std::max(0.0, within_mm) + lattice.cell_mm[axis];
    const auto tile = [&](double place) {
      return static_cast<int>(
          std::clamp(std::floor((place - lattice.origin_mm[axis]) / edge), 0.0, last));
    };
    low[axis] = tile(sweep.box_mm.min[axis] - margin);
    high[axis] = tile(sweep.box_mm.max[axis] + margin);
  }
  tiles_.clear();
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x)
        if (!tree_.tile(y * lattice.tiles[0] + x, z).is_empty()) tiles_.push_back({x, y, z, 0});
  keep_near(sweep, kTileNodes, within_mm, tiles_);
}

void BrickFinder::list_bricks(const Sweep& sweep, const Place& tile, double within_mm) {
  const TileRef& ref = tree_.tile(tile.y * tree_.lattice().tiles[0] + tile.x, tile.z);
  bricks_.clear();
  for (int b = 0; b < kBricksInTile; ++b) {
    if (ref.get() && ref->bricks[b].is_empty()) continue;
    bricks_.push_back({tile.x * kTileBricks + b % kTileBricks,
                       tile.y * kTileBricks + b / kTileBricks % kTileBricks,
                       tile.z * kTileBricks + b / (kTileBricks * kTileBricks), 0});
  }
  keep_near(sweep, kBrick, within_mm, bricks_);
}

}  // namespace kerf::octree
