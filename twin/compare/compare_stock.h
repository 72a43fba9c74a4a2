// twin/compare/compare_stock.h - a workpiece against the part as designed.
#pragma once

#include <span>

#include "stock/stock_model.h"
#include "twin/compare/comparison.h"
#include "twin/compare/design_part.h"
#include "twin/process/cut_labels.h"

namespace kerf {

class KeptMoves;

/// Who has cut the workpiece.
struct CutHistory {
  /// What the ids of StockModel::keep_cut_ids() mean. Empty: nobody knows.
  std::span<const CutLabel> labels;
  /// Null: walls are known to the model's cells only.
  const KeptMoves* kept = nullptr;
};

struct CompareSettings {
  double tolerance_mm = 0.05;
};

/// Compares the surface of the workpiece with the design's, from both sides: what of the workpiece
/// lies outside the design by more than the tolerance (excess), what of the surface that was left
/// lies inside (gouge), and what of the design is gone where no surface tells of it.
///
/// Of models of heights (Z-map, and M-map without gaps):
///   - The middle of each cell is a point of the true surface, to 0.0001 mm. Its distance from the
///     design is that from the design's triangles.
///   - Walls stand between the middles of two cells. With the moves (CutHistory::kept) it is worked
///     out where, to a thousandth of a cell; without, half a cell is taken off what is told.
///   - The worst place of a region is looked for between the cells' middles by the moves, to a 64th
///     of a cell. The tips of pointed cutters are looked at along their way, at every half cell.
/// Of all others the triangles of their surface are looked at, divided as in the window
/// (patch_deviation.h), and `walls_mm` says how far these may be off.
///
/// Places finer than that do not count: what is narrower than a cell, and neither a wall nor a
/// pointed tool's, may be missed.
///
/// Z-map, 2000 x 2000 cells, 1 000 000 triangles: tests/bench/bench_proof.
Comparison compare_stock(const StockModel& stock, const DesignPart& design,
                         const CompareSettings& settings, const CutHistory& history);

}  // namespace kerf
