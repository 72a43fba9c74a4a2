// twin/process/checked_move.h - a motion as checks of rigid bodies take it.
#pragma once

#include <span>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// A motion with what the checks need to know of it.
struct CheckedMove {
  const Motion& motion;
  const TimedStep& step;
  const Cutter& cutter;
  std::span<const CutMove> moves;  ///< it is cut as these
  int tool = 0;
  bool tool_guessed = false;
  std::span<const double> ends{};  ///< share of the motion at each move's end; empty: one move

  /// Of the motion, `t` of that move being done.
  double share_of(std::size_t which, double t) const {
    if (ends.empty()) return (static_cast<double>(which) + t) / static_cast<double>(moves.size());
    const double from = which == 0 ? 0 : ends[which - 1];
    return from + t * (ends[which] - from);
  }
  /// When that is.
  double time_s(std::size_t which, double t) const { return step.time_at(share_of(which, t)); }
};

}  // namespace kerf
