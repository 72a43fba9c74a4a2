#include "stock/zmap/height_view.h"

namespace kerf {

static_assert(HeightGrid::kTileCells == kTileCells && HeightGrid::kBlockX == kBlockX &&
              HeightGrid::kBlockY == kBlockY);

std::shared_ptr<const HeightGrid> height_view(const TileGrid& grid) {
  const auto shared = std::make_shared<const TileGrid>(grid);
  return std::make_shared<const HeightGrid>(shared->bounds_mm(), shared->nx(), shared->ny(),
                                            shared->tiles(), shared);
}

HeightGrid present_view(const TileGrid& grid) {
  return {grid.bounds_mm(), grid.nx(), grid.ny(), grid.tiles(), nullptr};
}

}  // namespace kerf
