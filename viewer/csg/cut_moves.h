// viewer/csg/cut_moves.h - a blank and the moves that cut it, as a value for the window.
#pragma once

#include <memory>
#include <vector>

#include "base/geometry.h"
#include "viewer/csg/csg_renderer.h"

namespace kerf {

/// Immutable once handed over. A later one may have more moves at its end, or longer ones, or quite
/// others: the window finds out what is new (csg_picture.h), so that what plays on costs no more
/// than its new moves.
struct CutMoves {
  Box blank_mm;  ///< The uncut workpiece is this box.
  /// SweptMove::tool indexes them. The same pointer means the same tools.
  std::shared_ptr<const std::vector<CsgTool>> tools;
  std::vector<SweptMove> moves;  ///< In the order of the program.
};

}  // namespace kerf
