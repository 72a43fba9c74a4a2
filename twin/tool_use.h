// twin/tool_use.h - what one tool did, for the report.
#pragma once

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
  double grain_s = 0;  ///< time and volume of the grain that is open (CutStage::take_timed)
  double grain_mm3 = 0;
};

/// Removal rates are taken over at least this much cutting time: single moves of a finishing pass
/// last milliseconds and remove whole cells or nothing.
inline constexpr double kPeakWindow_s = 0.5;

/// The rate of the window that is open, whatever its length; the next one begins.
inline void close_window(ToolUse& use) {
  if (use.window_s > 0 && use.window_mm3 > use.peak_mm3_per_s * use.window_s) {
    use.peak_mm3_per_s = use.window_mm3 / use.window_s;
  }
  use.window_s = use.window_mm3 = 0;
}

/// A feed move, or several, that removed so much in so long.
inline void add_cutting(ToolUse& use, double duration_s, double removed_mm3) {
  if (removed_mm3 <= 0) return;
  use.cut_s += duration_s;
  use.window_s += duration_s;
  use.window_mm3 += removed_mm3;
  if (use.window_s >= kPeakWindow_s) close_window(use);
}

}  // namespace kerf
