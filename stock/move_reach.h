// stock/move_reach.h - the part of a move that can matter to a blank. The last guard of the
// kernels: who reads programs and sensors has refused such numbers before.
#pragma once

#include <optional>

#include "stock/stock_model.h"

namespace kerf {

/// Moves farther than this from the blank, along any axis, are cut as far as here only.
inline constexpr double kMoveReach_mm = 1e6;
/// An arc of more turns is not cut, nor one about a centre this far away.
inline constexpr double kMostMoveTurns = 10'000;
inline constexpr double kFarthestMoveCenter_mm = 1e10;

/// The move itself where all its numbers are within reach: some comparisons. Else the part of a
/// straight move that is; nothing of other moves (arcs, turning spindles), and nothing where a
/// number is none (NaN, infinity). `reach_mm` beyond `blank` on every side.
std::optional<CutMove> within_reach(const CutMove& move, const Box& blank,
                                    double reach_mm = kMoveReach_mm);

}  // namespace kerf
