// stock/turning/tap.h - what a tap is that goes along the axis in step with the workpiece.
#pragma once

#include <optional>

#include "stock/turning/turned_part.h"

namespace kerf {

/// A tap of ISO 68-1's profile, 60 degrees: flanks to a root P/8 wide at its diameter. Its core,
/// 0.6134 P below, clears the hole where that is narrower. One groove from its tip on: its chamfer,
/// which spreads the cut over some turns, and leaves those last ones shallow, is not there.
struct TapTools {
  TurningTool core;    ///< to be cut as a ring
  TurningTool groove;  ///< in step
};
/// None: the pitch leaves no core.
std::optional<TapTools> tap_tools(double diameter_mm, double pitch_mm, double length_mm);

}  // namespace kerf
