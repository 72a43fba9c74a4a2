// stock/octree/part_bodies.h - what a tool carries above its cutting edges, and these by
// themselves, as bodies of sweeps.
#pragma once

#include <span>
#include <vector>

#include "stock/cutter/cutter.h"
#include "stock/octree/tool_bodies.h"
#include "stock/stock_model.h"

namespace kerf::octree {

/// A cylinder, `raised_mm` shorter from below. Its function is the true distance everywhere, around
/// its rims as well.
ToolBody part_body(const CarriedPart& part, double raised_mm = 0);

/// The bodies of the cutter up to the end of its flutes; as they are, where nobody says where these
/// end.
std::vector<ToolBody> flute_bodies(const Cutter& cutter, std::span<const ToolBody> bodies);

}  // namespace kerf::octree
