// twin/process/turning/turn_steps.h - a turning move step by step.
#pragma once

#include "stock/turning/turn_move.h"

namespace kerf {

/// From share `from` to share `to` of a move.
TurnMove turn_part(const TurnMove& move, double from, double to);
/// How long its way is, or a little more.
double turn_way_mm(const TurnMove& move);

}  // namespace kerf
