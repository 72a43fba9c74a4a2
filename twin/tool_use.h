// twin/tool_use.h - what one tool did, for the report.
#pragma once

#include <algorithm>
#include <limits>
#include <string>

namespace kerf {

struct ToolUse {
  int number = 0;
  std::string shape;  ///< SHAPE text; empty: undefined, did not cut
  std::string origin;
  bool guessed = false;
  double cut_s = 0;    ///< time of feed moves that removed material
  double feed_mm = 0;  ///< length of all its feed moves
  double removed_mm3 = 0;
  double max_depth_mm = 0;    ///< greatest height of material that one move removed
  double peak_mm3_per_s = 0;  ///< greatest removal rate over kPeakWindow_s of cutting
  double window_s = 0;        ///< cutting time and volume of the window that is open
  double window_mm3 = 0;
  double window_bound_mm3_per_s = 0;  ///< greatest of what its moves can have removed
  double grain_s = 0;  ///< time and volume of the grain that is open (CutStage::take_timed)
  double grain_mm3 = 0;
};

/// Removal rates are taken over at least this much cutting time: single moves of a finishing pass
/// last milliseconds and remove whole cells or nothing.
inline constexpr double kPeakWindow_s = 0.5;

/// The rate of the window that is open, whatever its length; the next one begins.
inline void close_window(ToolUse& use) {
  if (use.window_s > 0) {
    const double rate = std::min(use.window_mm3 / use.window_s, use.window_bound_mm3_per_s);
    use.peak_mm3_per_s = std::max(use.peak_mm3_per_s, rate);
  }
  use.window_s = use.window_mm3 = use.window_bound_mm3_per_s = 0;
}

/// A feed move, or several, that removed so much in so long. `bound_mm3_per_s`: no tool of that
/// size can be faster. A model tells what the cutter's front takes of the last of several moves in
/// a row: the volume is right, and their sum; the rate of the last one is not.
inline void add_cutting(ToolUse& use, double duration_s, double removed_mm3,
                        double bound_mm3_per_s = std::numeric_limits<double>::infinity()) {
  if (removed_mm3 <= 0) return;
  use.cut_s += duration_s;
  use.window_s += duration_s;
  use.window_mm3 += removed_mm3;
  use.window_bound_mm3_per_s = std::max(use.window_bound_mm3_per_s, bound_mm3_per_s);
  if (use.window_s >= kPeakWindow_s) close_window(use);
}

}  // namespace kerf
