// stock/zmap/mmap/headed_tool.h - a cutter with a head wider than its neck, as convex tools.
#pragma once

#include <vector>

#include "stock/stock_model.h"
#include "stock/zmap/sweep_ops.h"

namespace kerf {

/// The body of a cutter: all points between the lower and the upper side of its head, and all
/// points above its lower side that are no farther from the axis than the neck.
///
///        : ray :            Over a point, each of the two parts of a tool that stands somewhere is
///        :     :            one interval of heights, whose ends change steadily with the distance
///      __:_____:__          from the axis. So a part that moves without leaving the point sweeps
///     |   head    |         one interval as well: from the lowest of its lower ends to the highest
///     |___________|         of its upper ends.
struct HeadedTool {
  std::vector<ConvexTool> rays;   ///< what they sweep goes on upward without end
  std::vector<ConvexTool> lower;  ///< lower side of the head; empty without a neck
  /// Upper side of the head, turned over: the surface of such a tool is the negative height above
  /// the tip. It sweeps the head's upper side along a path that is turned over too.
  std::vector<ConvexTool> upper;
  double radius_mm = 0;
};
HeadedTool headed_tool(const Cutter& cutter);

/// The parts of a move (chords, pieces of a helix) during each of which a head of that radius comes
/// over no point twice, or over all points at one height: straight and level moves as they are,
/// helices in pieces of less than half a turn if their radius is no less than the head's, all else
/// as chords within kChordTolerance_mm.
std::vector<CutMove> head_sweeps(const CutMove& move, double radius_mm);

/// The move with the heights of all its points negative. For moves that are straight, or circles or
/// helices in XY.
CutMove turned_over(const CutMove& move);

}  // namespace kerf
