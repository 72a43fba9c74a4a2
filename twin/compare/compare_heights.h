// twin/compare/compare_heights.h - the deviations of a workpiece that is a grid of heights.
#pragma once

#include "stock/stock_model.h"
#include "surface/height_grid.h"
#include "twin/compare/design_part.h"
#include "twin/compare/deviation_sums.h"
#include "twin/process/kept_moves.h"

namespace kerf {

/// What compare_stock() does of heights. `kept`: null where the moves are not known exactly.
struct HeightComparison {
  bool has_exact_walls = true;  ///< all walls have been worked out from the moves
};
HeightComparison compare_heights(const StockModel& stock, const HeightGrid& heights,
                                 const DesignPart& design, const KeptMoves* kept,
                                 DeviationSums& sums);

/// Looks for the worst place of a region near the one that was found, in between the middles of
/// cells: by the moves themselves. True: it has found a worse one.
bool sharpen(const DesignPart& design, const KeptMoves& kept, double cell_mm, FoundRegion& region);

}  // namespace kerf
