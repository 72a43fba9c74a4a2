// twin/process/turning/tool_plates.h - turning tools in space: against what stands beside the
// workpiece.
#pragma once

#include <vector>

#include "stock/cutter/cutter.h"
#include "twin/process/carried_bodies.h"

namespace kerf {

/// What cuts, and what holds it. An outline says nothing of Y, so:
///
///     holder   W wide in its outline (the lesser of its sides): a square shank with one face at
///              centre height, nobody says which: it is taken from Y-W to Y+W
///     bar      lies along the axis and is round: from -W/2 to W/2
///     insert   as its holder or bar, on which it lies; without one kBarePlate_mm either way
///
/// A tool without an insert (a drill in the tailstock) is what tool_bodies() says.
std::vector<CarriedBody> standing_bodies(const Cutter& cutter);

/// Half as wide as an insert is taken that nothing holds.
inline constexpr double kBarePlate_mm = 5;

}  // namespace kerf
