// twin/motion_nearest.h - the point of a motion's way that lies nearest to a place. mm.
#pragma once

#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// A place on the way of a motion.
struct NearestPoint {
  double t = 0;  ///< fraction of the way (of the angle, for arcs), as in point_at()
  double distance_mm = 0;
};

/// The nearest point at or after fraction `from_t`. Where an arc of several turns passes the place
/// more than once as near (within 1 um), the first passage. Lines and circles exactly; helices and
/// spirals to within 0.1 um as long as they rise or grow by less than a radius a turn.
NearestPoint nearest_on(const Motion& motion, const Vec3& place_mm, double from_t);

/// The part of a motion between two fractions of its way, 0 <= from_t <= to_t <= 1. With 0 and 1
/// the motion itself, bit for bit.
Motion part_of(const Motion& motion, double from_t, double to_t);

}  // namespace kerf
