// twin/process/loose_piece.h - a piece of a workpiece that has been milled into several.
#pragma once

#include <optional>
#include <vector>

#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// What hangs together.
struct PieceBody {
  double volume_mm3 = 0;
  Box box_mm;
};

/// It has come free, or is held at the end (`held`: then all below is empty).
struct LoosePiece {
  PieceBody body;  ///< right after the move that freed it
  bool held = false;
  SourceRef source{};  ///< of the motion that freed it
  double time_s = 0;
  int tool = 0;
  std::vector<PieceBody> left{};      ///< what is there of it at the end, without crumbs
  std::optional<SourceRef> cut_by{};  ///< the first that cuts on in it
};

}  // namespace kerf
