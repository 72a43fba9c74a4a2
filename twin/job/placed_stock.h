// twin/job/placed_stock.h - a workpiece as it lies now, in a model that what comes next can cut.
#pragma once

#include <memory>
#include <string>

#include "base/placement.h"
#include "base/result.h"
#include "stock/stock_model.h"
#include "twin/job/stock_choice.h"

namespace kerf {

/// How a workpiece has come from one model into another.
struct CarriedOver {
  std::string from, to;  ///< models: "zmap", "octree"
  double bound_mm = 0;   ///< what is solid now and was not, or was, is no farther from the surface
  std::string note;      ///< what was left behind; empty: nothing
};

struct PlacedStock {
  std::unique_ptr<StockModel> stock;
  CarriedOver carried;
};

/// The box of what is left, not of the blank: of its surface, less than a cell's rounding.
Box solid_bounds(const StockModel& stock);

/// `stock` as it lies after `placement`, in the model that holds it with the least loss:
///
///     as it was                    any            itself
///     Z stays along Z, square      heights        heights, with gaps where it is turned over
///     square                       octree         octree
///     a turn about X0 Z0 along X   turned part    turned part, `lathe` goes on with it
///     anything                     turned part    octree, by its exact profile
///     anything else                all of these   octree, by the finest surface of the model
///
/// An octree if `needs_octree`. `lathe`: what comes next is for a lathe; else a turned part becomes
/// an octree. `cell_mm` is that of an octree that is made anew; 0: as fine as what it is made of,
/// or as what suits the blank, whichever is coarser. Error: what cannot lie so, and what could.
Result<PlacedStock> place_stock(std::unique_ptr<StockModel> stock, const Placement& placement,
                                bool needs_octree, bool lathe, const StockSettings& settings);

}  // namespace kerf
