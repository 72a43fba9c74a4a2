#include "stock/zmap/height_view.h"

namespace kerf {

static_assert(HeightGrid::kTileCells == kTileCells && HeightGrid::kBlockX == kBlockX &&
              HeightGrid::kBlockY == kBlockY);

namespace {

std::vector<const float*> tiles_of(const TileGrid& grid) {
  std::vector<const float*> tiles(grid.tile_count());
  for (std::size_t n = 0; n < tiles.size(); ++n) tiles[n] = grid.tile(n);
  return tiles;
}

}  // namespace

std::shared_ptr<const HeightGrid> height_view(const TileGrid& grid) {
  const auto shared = std::make_shared<const TileGrid>(grid);
  return std::make_shared<const HeightGrid>(shared->bounds_mm(), shared->nx(), shared->ny(),
                                            tiles_of(*shared), shared);
}

HeightGrid present_view(const TileGrid& grid) {
  return {grid.bounds_mm(), grid.nx(), grid.ny(), tiles_of(grid), nullptr};
}

}  // namespace kerf
