// twin/diff/part_diff.h - whether two workpieces are the same, and where they are not.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "stock/stock_model.h"
#include "twin/process/cut_labels.h"

namespace kerf {

/// A workpiece with what is known of who cut it.
struct DiffedPart {
  const StockModel* stock = nullptr;
  const CutLabels* labels = nullptr;  ///< null: nothing
};

struct PartDiff {
  bool same = false;
  bool equal_bits = false;      ///< by digest
  std::string not_compared;     ///< not empty: why surfaces were not held against each other
  double a_mm3 = 0, b_mm3 = 0;  ///< what is left of each

  /// What was measured: along Z where both are heights over the same cells, else the distance of
  /// points of either's surface, a cell apart, from the other's surface.
  bool by_heights = false;
  double most_mm = 0;
  Vec3 at_mm{0};
  std::optional<CutLabel> a_cut, b_cut;  ///< who made the surface there

  // Of heights: area and volumes of what differs by more than the tolerance.
  double area_mm2 = 0;
  double a_more_mm3 = 0, b_more_mm3 = 0;
  /// Cells at walls of which a neighbour has the height of the other: the wall moved by less than
  /// a cell, how far the cells do not tell. Not in most_mm.
  std::size_t wall_cells = 0;
  double cell_mm = 0;
};

/// `walls_count`: walls that have moved by less than a cell are a difference; not if the motions
/// that cut them are known to be the same within a tolerance. Both in the same coordinates.
/// Heights: O(cells), some 10 ns each. Surfaces: about 1 us a point, 2 million points of either at
/// most.
PartDiff diff_parts(const DiffedPart& a, const DiffedPart& b, double tolerance_mm,
                    bool walls_count);

}  // namespace kerf
