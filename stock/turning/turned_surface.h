// stock/turning/turned_surface.h - whether a workpiece's surface is of contours or of cells.
#pragma once

#include "stock/turning/turning_stock.h"

namespace kerf {

/// A turned part that no driven tool has milled: exact, its cell_mm() is no size that is looked at.
inline bool is_turned_alone(const StockModel& stock) {
  return stock.turned() != nullptr && stock.cell_mm() == stock.turned()->cell_mm();
}

/// How fine it is to be looked at: the edge of a cell, or what stands for it where there are none.
inline double detail_cell_mm(const StockModel& stock) {
  constexpr double kOfContours_mm = 0.1;
  return stock.sheet() != nullptr || is_turned_alone(stock) ? kOfContours_mm : stock.cell_mm();
}

}  // namespace kerf
