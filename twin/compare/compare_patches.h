// twin/compare/compare_patches.h - the deviations of a workpiece by the triangles of its surface.
#pragma once

#include <algorithm>

#include "stock/stock_model.h"
#include "twin/compare/design_part.h"
#include "twin/compare/deviation_sums.h"

namespace kerf {

/// How far the surface that a model shows may be off.
struct SurfaceDoubt {
  double anywhere_mm = 0;
  double walls_mm = 0;  ///< of walls, what meets them, and at the borders of tiles
  double most_mm() const { return std::max(anywhere_mm, walls_mm); }
};

/// What compare_stock() does of any model: triangles by their vertices' deviations, less the doubt;
/// volumes by vertical lines through the closed surface, a `cell_mm` apart (wider, so that there
/// are a million at most).
void compare_patches(const StockModel& stock, double cell_mm, const DesignPart& design,
                     const SurfaceDoubt& doubt, DeviationSums& sums);

}  // namespace kerf
