// stock/zmap/height_view.h - the heights of a Z-map for whoever only looks at them.
#pragma once

#include <memory>

#include "stock/zmap/tile_grid.h"
#include "surface/height_grid.h"

namespace kerf {

/// The heights as they are now. Shares the tiles of `grid`, as a copy of it would: later changes of
/// `grid` go to copies of the tiles and are not seen here. Costs some nanoseconds a tile. May be
/// read and dropped on another thread.
std::shared_ptr<const HeightGrid> height_view(const TileGrid& grid);
/// The same without a copy: until `grid` is changed or gone.
HeightGrid present_view(const TileGrid& grid);

}  // namespace kerf
