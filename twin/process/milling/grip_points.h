// twin/process/milling/grip_points.h - where fixtures hold a workpiece.
#pragma once

#include <vector>

#include "base/geometry.h"
#include "stock/stock_model.h"
#include "twin/job/fixtures.h"

namespace kerf {

/// Points of the workpiece as it is now, half a cell inside its surface, where a fixture touches it
/// from the side or from above: jaws, clamps, screws. What only lies on a fixture is not held by
/// it. Those that stand on links of a machine do not count. Some milliseconds a fixture.
std::vector<Vec3> grip_points(const StockModel& stock, const FixtureList& fixtures);

}  // namespace kerf
