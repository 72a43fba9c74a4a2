// stock/turning/turned_gap.h - how near a tool comes to a turned part that it does not touch.
#pragma once

#include <optional>

#include "stock/turning/turn_move.h"
#include "stock/turning/turned_part.h"

namespace kerf {

struct TurnGap {
  double mm = 0;  ///< 0: it touches
  double t = 0;   ///< share of the move after which it first is so near
  Vec2 at_mm{0};  ///< the controlled point then, (z, x)
};

/// The least distance between them on the move, in the plane of the axis, if it is below
/// `below_mm`. As exact as the coordinates (turned_part.h). Of a move beyond the axis both sides
/// count. O(corners of the part near the way times those of the tool); boxes first. Where the boxes
/// of both come nearer than that, O(corners of the part) as well.
std::optional<TurnGap> least_gap(const TurnedPart& part, const TurningTool& tool,
                                 const TurnMove& move, double below_mm);

}  // namespace kerf
