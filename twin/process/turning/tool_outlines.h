// twin/process/turning/tool_outlines.h - a turning tool's outline as checks take it.
#pragma once

#include "stock/cutter/cutter.h"
#include "stock/cutter/insert.h"

namespace kerf {

bool is_cutting(InsertSide side);

/// What cuts with all that is one piece with it, and what holds that: parts none of whose edges
/// cuts. Either may be without parts. Of a drill it is as it stands along the axis.
struct ToolOutlines {
  InsertOutline cutter, holder;
};
ToolOutlines outlines_of(const Cutter& cutter);

/// Around it, (z, x); arcs as whole circles. Of no parts low is above high.
void outline_box(const InsertOutline& outline, Vec2& low_mm, Vec2& high_mm);

}  // namespace kerf
