// stock/zmap/mmap/placed_columns.h - a workpiece of heights, or of heights with gaps, as it lies
// elsewhere.
#pragma once

#include <memory>

#include "base/placement.h"
#include "base/result.h"
#include "stock/stock_model.h"
#include "stock/zmap/zmap_kernel.h"

namespace kerf {

struct PlacedColumns {
  std::unique_ptr<StockModel> stock;  ///< a Z-map, or an M-map where there are gaps
  double bound_mm = 0;                ///< by how much a height may differ: rounding of floats
};

/// Columns stay columns where Z stays along Z: their cells change places, and of what is turned
/// over each column is read from below, so that what was cut from above is a gap below a flat top.
/// Nothing is searched and nothing lost. The floor of what is turned over is the lowest material.
/// `heights` is a ZMap or an MMap without moves held back. blank_mm3() stays what it was. Error: it
/// holds no material.
Result<PlacedColumns> placed_columns(const StockModel& heights, const AxisTurn& turn,
                                     const Vec3& at_mm, int threads, ZMapKernel kernel);

}  // namespace kerf
