// twin/scene/turned_finding_view.h - what of a finding on a lathe is to be seen: in the plane of
// the axis, Z to the right, X up.
#pragma once

#include "twin/scene/finding_view.h"

namespace kerf {

/// Its tool stands still and the workpiece turns below it: an insert, a drill on the axis.
bool is_turned_shot(const FindingShot& shot);

/// Of such a shot. The place is where the outlines of the two bodies are nearest to each other, or
/// the deepest corner of one in the other; of a finding of one body the controlled point.
FindingView turned_finding_view(const FindingShot& shot, BodyWatch& watch);

}  // namespace kerf
