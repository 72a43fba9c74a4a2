// twin/scene/contact_places.h - where on a tool two bodies touch: for marks and for eyes.
#pragma once

#include <optional>

#include "base/geometry.h"
#include "stock/stock_model.h"
#include "twin/collision/solid.h"
#include "twin/collision/tool_bodies.h"
#include "twin/machine/kinematics/pose.h"

namespace kerf {

/// A point that is as near as any to both, within some hundredths of a millimetre, or in both. By
/// boxes that are halved, some hundred at most: about a millisecond. The poses are those in the
/// workpiece frame. None: they are far apart.
std::optional<Vec3> place_between(const Solid& a, const Pose& a_pose, const Solid& b,
                                  const Pose& b_pose);

/// Of the corners of the workpiece's surface, as patches of level 0 have it, the one that lies
/// deepest in shank, holder or spindle, or no farther from it than a cell and a half; none: no one
/// does. Makes the patches of the tiles about that body: milliseconds.
std::optional<Vec3> place_on_workpiece(const ToolBody& body, const Pose& tool,
                                       const StockModel& stock);

/// Of the same corners the one that is nearest to any body; none: it is farther than a cell and a
/// half. Microseconds for each corner about it.
std::optional<Vec3> place_on_workpiece(const Solid& body, const Pose& pose,
                                       const StockModel& stock);

}  // namespace kerf
