// twin/process/fallen_piece.h - what comes off a workpiece that turns.
#pragma once

#include "interp_bridge/motion.h"
#include "stock/turning/turned_part.h"

namespace kerf {

/// With what did it.
struct FallenPiece {
  TurnedPiece piece;
  SourceRef source;
  double time_s = 0;
  int tool = 0;
};

}  // namespace kerf
