// viewer/csg/cut_moves.h - a blank and the moves that cut it, as a value for the window.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "base/geometry.h"
#include "viewer/csg/csg_renderer.h"

namespace kerf {

/// Immutable once handed over. A later one may have more moves at its end, or longer ones, or leave
/// out more at the front, or have quite others: the window finds out what is new (csg_picture.h),
/// so that what plays on costs no more than its new moves.
struct CutMoves {
  Box blank_mm;  ///< The uncut workpiece is this box.
  /// SweptMove::tool indexes them. The same pointer means the same tools.
  std::shared_ptr<const std::vector<CsgTool>> tools;
  std::vector<SweptMove> moves;  ///< In the order of the program.
  /// So many motions at the front of the program were cut too, but would take too long to draw.
  std::size_t left_out = 0;
};

}  // namespace kerf
