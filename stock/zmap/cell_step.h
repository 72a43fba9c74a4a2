// stock/zmap/cell_step.h - an upright wall between the middles of two cells.
#pragma once

#include <cstdint>

namespace kerf {

/// Between cell (i, j) and the next one along x (axis 0) or y (axis 1).
///
///          |----- higher
///          |
///   foot --|                o     o  middles
///   lower -'    part: 0 at the middle of (i, j), 1 at the next
///
struct CellStep {
  std::int32_t i = 0, j = 0;
  std::int8_t axis = 0;
  float part = 0.5f;
  float foot_mm = 0;  ///< where the wall begins, no lower than the lower cell
};

}  // namespace kerf
