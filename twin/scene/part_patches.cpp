#include "twin/scene/part_patches.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

/// Joined cells may be larger than a pixel by a quarter: then a workpiece that fills the picture is
/// as fine at its near end as in its middle.
constexpr double kCellsPerPixel = 1.6;

}  // namespace

int patch_level(double pixel_mm, double cell_mm) {
  const double joined = pixel_mm / (cell_mm * kCellsPerPixel);
  if (!(joined >= 1)) return 0;
  const int level = 1 + static_cast<int>(std::floor(std::log2(joined)));
  return std::min(level, StockModel::kPatchLevels - 1);
}

PartPatches part_patches(const StockModel& stock) {
  return {stock.bounds_mm(), stock.tile_count(), [&stock](std::size_t tile, double pixel_mm) {
            return stock.patch(static_cast<std::uint32_t>(tile),
                               patch_level(pixel_mm, stock.cell_mm()));
          }};
}

}  // namespace kerf
