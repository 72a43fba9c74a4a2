// twin/process/drill_shape.h - which tools are drills, and how pointed.
#pragma once

#include "stock/cutter/cutter.h"

namespace kerf {

bool is_drill(const Cutter& cutter);
/// Whole angle of its point; 180 of one that has none.
double drill_point_deg(const Cutter& cutter);
/// With drills that are as pointed people mill chamfers and letters: sideways is no error.
inline constexpr double kSpotting_deg = 100;

}  // namespace kerf
