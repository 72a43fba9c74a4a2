#include "stock/zmap/height_view.h"

namespace kerf {

static_assert(HeightGrid::kTileCells == kTileCells && HeightGrid::kBlockX == kBlockX &&
              HeightGrid::kBlockY == kBlockY);

std::shared_ptr<const HeightGrid> height_view(const TileGrid& grid) {
  const auto shared = std::make_shared<const TileGrid>(grid);
  std::vector<const float*> tiles(shared->tile_count());
  for (std::size_t n = 0; n < tiles.size(); ++n) tiles[n] = shared->tile(n);
  return std::make_shared<const HeightGrid>(shared->bounds_mm(), shared->nx(), shared->ny(),
                                            std::move(tiles), shared);
}

}  // namespace kerf
