#include "twin/scene/part_patches.h"

#include <algorithm>
#include <cmath>

#include "stock/turning/turning_stock.h"

namespace kerf {
namespace {

/// Joined cells may be larger than a pixel by a quarter: then a workpiece that fills the picture is
/// as fine at its near end as in its middle.
constexpr double kCellsPerPixel = 1.6;
/// Of a turned part: share of a pixel by which a contour may be off, and what stands for cells.
constexpr double kUnseenPixels = 0.25;
constexpr double kTurnedCell_mm = 0.1;

/// Of contours; once it is milled as well it has cells.
bool is_exact(const StockModel& stock) {
  return stock.turned() && stock.cell_mm() == stock.turned()->cell_mm();
}

}  // namespace

int patch_level(double pixel_mm, double cell_mm) {
  const double joined = pixel_mm / (cell_mm * kCellsPerPixel);
  if (!(joined >= 1)) return 0;
  const int level = 1 + static_cast<int>(std::floor(std::log2(joined)));
  return std::min(level, StockModel::kPatchLevels - 1);
}

int patch_level(const StockModel& stock, double pixel_mm) {
  return is_exact(stock) ? TurnedPart::level_within(kUnseenPixels * pixel_mm)
                         : patch_level(pixel_mm, stock.cell_mm());
}

double patch_cell_mm(const StockModel& stock) {
  return is_exact(stock) ? kTurnedCell_mm : stock.cell_mm();
}

PartPatches part_patches(const StockModel& stock) {
  return {stock.bounds_mm(), stock.tile_count(), [&stock](std::size_t tile, double pixel_mm) {
            return stock.patch(static_cast<std::uint32_t>(tile), patch_level(stock, pixel_mm));
          }};
}

}  // namespace kerf
