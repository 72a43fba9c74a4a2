#include "twin/scene/part_patches.h"

#include <algorithm>
#include <cmath>

#include "stock/turning/turned_surface.h"

namespace kerf {
namespace {

/// Joined cells may be larger than a pixel by a quarter: then a workpiece that fills the picture is
/// as fine at its near end as in its middle.
constexpr double kCellsPerPixel = 1.6;
/// Of a turned part: share of a pixel by which a contour may be off.
constexpr double kUnseenPixels = 0.25;

}  // namespace

int patch_level(double pixel_mm, double cell_mm) {
  const double joined = pixel_mm / (cell_mm * kCellsPerPixel);
  if (!(joined >= 1)) return 0;
  const int level = 1 + static_cast<int>(std::floor(std::log2(joined)));
  return std::min(level, StockModel::kPatchLevels - 1);
}

int patch_level(const StockModel& stock, double pixel_mm) {
  return is_turned_alone(stock) ? TurnedPart::level_within(kUnseenPixels * pixel_mm)
                                : patch_level(pixel_mm, stock.cell_mm());
}

PartPatches part_patches(const StockModel& stock) {
  return {stock.bounds_mm(), stock.tile_count(), [&stock](std::size_t tile, double pixel_mm) {
            return stock.patch(static_cast<std::uint32_t>(tile), patch_level(stock, pixel_mm));
          }};
}

}  // namespace kerf
