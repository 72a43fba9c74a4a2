// twin/process/milling/tool_side.h - where on a slope a tool is lowest over a point, in closed
// form.
#pragma once

#include <optional>

#include "stock/cutter/cutter.h"

namespace kerf {

/// The end is half a sphere of the cutter's radius.
bool is_ball_end(const Cutter& cutter);

/// What a tool's end is, if it is one of which that is known: half a sphere, or a cone.
struct ToolSide {
  bool is_ball = false;
  double slope = 0, flat_mm = 0;  ///< of a cone's side, from a flat end on; 0: it is none

  static ToolSide of(const Cutter& cutter);
  /// Its way rises by `rise` for each mm, seen from above, and passes `beside_mm` beside the point,
  /// over which it is for `half_mm` before and after it is nearest to it. Where it is lowest there,
  /// in mm of the way after that; farther than `half_mm`: at that end. `margin_mm`: it counts as
  /// wider by that. Null: it is neither.
  std::optional<double> lowest_mm(double rise, double beside_mm, double half_mm,
                                  double margin_mm) const;
};

}  // namespace kerf
