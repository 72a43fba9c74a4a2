// twin/job/tool_use.h - what one tool did, for the report.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "interp_bridge/motion.h"
#include "twin/job/tool_loads.h"

namespace kerf {

/// What the teeth of a tool have to do, where their number is known: of its feed moves that removed
/// material, with the speed that the planner reaches.
struct ChipLoad {
  double most_mm = 0;  ///< feed per tooth
  SourceRef most_at;
  double sum_mm_s = 0, seconds = 0;  ///< for the mean, by time
  /// Greatest cutting speed, at the widest place of the tool in what a move removes.
  double speed_m_per_min = 0;

  bool is_known() const { return seconds > 0; }
  double mean_mm() const { return is_known() ? sum_mm_s / seconds : 0; }
  /// Of a move: its most and its mean feed per tooth.
  void add(double move_most_mm, double move_mean_mm, double duration_s, const SourceRef& source) {
    sum_mm_s += move_mean_mm * duration_s;
    seconds += duration_s;
    if (move_most_mm <= most_mm) return;
    most_mm = move_most_mm;
    most_at = source;
  }
};

struct ToolUse {
  int number = 0;
  std::string shape;  ///< SHAPE text; empty: undefined, did not cut
  std::string origin;
  bool guessed = false;
  std::optional<int> teeth;  ///< where its shape says it
  /// Its length offsets along X Y Z, of the tool table; none: no row has any.
  std::optional<std::array<double, 3>> offset_mm;
  ChipLoad chip;
  std::shared_ptr<const ToolLoads> loads;  ///< where engagement was measured and teeth are known
  /// Its shank, its holder against the workpiece; false: nobody described them, or the model does
  /// not look.
  bool shank_checked = false, holder_checked = false;
  double cut_s = 0;    ///< time of feed moves that removed material
  double feed_mm = 0;  ///< length of all its feed moves
  double removed_mm3 = 0;
  double max_depth_mm = 0;    ///< greatest height of material that one move removed
  double peak_mm3_per_s = 0;  ///< greatest removal rate: LoadMeter, and windows of short moves
  double window_s = 0;        ///< cutting time, way and volume of the window that is open
  double window_mm = 0;
  double window_mm3 = 0;
  double window_bound_mm3_per_s = 0;  ///< greatest of what its moves can have removed
  double grain_s = 0;  ///< time and volume of the grain that is open (CutStage::take_timed)
  double grain_mm3 = 0;
  /// Of feed moves since the last that removed something; infinity: it is over.
  double gap_s = 0;
  double gap_mm = std::numeric_limits<double>::infinity();
};

/// Removal rates of short moves are taken over at least this much cutting time, and over the way of
/// some cells (FeedPart): single moves of a finishing pass last milliseconds and remove whole cells
/// or nothing.
inline constexpr double kPeakWindow_s = 0.5;

/// The rate of the window that is open, whatever its length; the next one begins.
inline void close_window(ToolUse& use) {
  if (use.window_s > 0) {
    const double rate = std::min(use.window_mm3 / use.window_s, use.window_bound_mm3_per_s);
    use.peak_mm3_per_s = std::max(use.peak_mm3_per_s, rate);
  }
  use.window_s = use.window_mm = use.window_mm3 = use.window_bound_mm3_per_s = 0;
}

/// A feed move, or several, that removed so much in so long. `bound_mm3_per_s`: no tool of that
/// size can be faster. A model tells what the cutter's front takes of the last of several moves in
/// a row: the volume is right, and their sum; the rate of the last one is not.
inline void add_cutting(ToolUse& use, double duration_s, double removed_mm3,
                        double bound_mm3_per_s = std::numeric_limits<double>::infinity(),
                        double least_mm = 0) {
  if (removed_mm3 <= 0) return;
  use.cut_s += duration_s;
  use.window_s += duration_s;
  use.window_mm3 += removed_mm3;
  use.window_bound_mm3_per_s = std::max(use.window_bound_mm3_per_s, bound_mm3_per_s);
  if (use.window_s >= kPeakWindow_s && use.window_mm >= least_mm) close_window(use);
}

/// A feed move that was not looked at on its own, as far as it is where the blank was.
struct FeedPart {
  bool known = false;
  double seconds = 0, way_mm = 0;  ///< 0: it is not there
  bool enters = false;             ///< it came from where the blank never was
  /// Of that, until the cutter's middle leaves the blank's box; negative: it does not.
  double leaves_s = -1, leaves_mm = 0;
  /// What lies between two moves that remove cells is cutting time as long as it is no longer:
  /// moves shorter than a cell remove some now and then and nothing between.
  double near_mm = 0;
  double window_mm = 0;  ///< the least way that a rate is taken over
};

/// `front_mm`: where a stretch of cutting begins with this move, how far before it the cutter's
/// front was in material. A model tells what the front takes with the move that brings the cutter's
/// middle there.
inline void add_short_move(ToolUse& use, const FeedPart& part, double removed_mm3,
                           double bound_mm3_per_s, double front_mm) {
  constexpr double kOver = std::numeric_limits<double>::infinity();
  if (part.way_mm <= 0) {  // the next one enters
    use.gap_s = use.gap_mm = 0;
    return;
  }
  if (part.enters) use.gap_s = use.gap_mm = 0;
  const bool leaves = part.leaves_s >= 0;
  const double seconds = leaves ? part.leaves_s : part.seconds;
  const double way_mm = leaves ? part.leaves_mm : part.way_mm;
  if (removed_mm3 > 0) {
    const double counts_mm = std::max(part.near_mm, front_mm);
    const double counts = use.gap_mm <= counts_mm ? 1 : counts_mm / use.gap_mm;
    if (use.gap_mm < kOver && use.gap_mm > 0) {
      use.cut_s += counts * use.gap_s;
      use.window_s += counts * use.gap_s;
      use.window_mm += counts * use.gap_mm;
    }
    use.window_mm += way_mm;
    add_cutting(use, seconds, removed_mm3, bound_mm3_per_s, part.window_mm);
    use.gap_s = use.gap_mm = 0;
  } else {
    use.gap_s += seconds;
    use.gap_mm += way_mm;
    if (leaves && use.gap_mm <= part.near_mm) use.cut_s += use.gap_s;
  }
  if (leaves) use.gap_mm = kOver;
}

}  // namespace kerf
