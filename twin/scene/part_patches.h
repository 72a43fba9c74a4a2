// twin/scene/part_patches.h - the surface of a workpiece for a picture.
#pragma once

#include "stock/stock_model.h"
#include "viewer/picture.h"

namespace kerf {

/// Level of patches (StockModel::patch()) for a place where a pixel shows `pixel_mm`: cells much
/// finer than that are joined. 0 where nothing is seen (pixel_mm <= 0).
int patch_level(double pixel_mm, double cell_mm);
/// The same of a workpiece, which may have no cells.
int patch_level(const StockModel& stock, double pixel_mm);

/// All patches of `stock` at the level that suits the picture; one for all, so that they meet
/// without skirts. `stock` must outlive the result, and not be changed while that is drawn.
PartPatches part_patches(const StockModel& stock);

}  // namespace kerf
