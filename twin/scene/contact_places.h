// twin/scene/contact_places.h - where on a tool two bodies touch: for marks and for eyes.
#pragma once

#include <optional>

#include "base/geometry.h"
#include "stock/stock_model.h"
#include "twin/collision/tool_bodies.h"
#include "twin/job/fixtures.h"

namespace kerf {

/// A point that is as near as any to both, within some hundredths of a millimetre, or in both. By
/// boxes that are halved, some hundred at most: about a millisecond. `tool`: its place in the
/// workpiece frame, the tip the origin.
std::optional<Vec3> place_between(const ToolBody& body, const Pose& tool, const Fixture& fixture);

/// Of the corners of the workpiece's surface, as patches of level 0 have it, the one that lies
/// deepest in shank, holder or spindle, or no farther from it than a cell and a half; none: no one
/// does. Makes the patches of the tiles about that body: milliseconds.
std::optional<Vec3> place_on_workpiece(const ToolBody& body, const Pose& tool,
                                       const StockModel& stock);

}  // namespace kerf
