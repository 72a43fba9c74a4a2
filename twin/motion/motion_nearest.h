// twin/motion/motion_nearest.h - the point of a motion's way that lies nearest to a place. mm.
#pragma once

#include <array>

#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// A place on the way of a motion.
struct PointOnWay {
  double t = 0;  ///< fraction of the way (of the angle, for arcs), as in point_at()
  double distance_mm = 0;
};

/// The nearest point between the fractions `from_t` and `to_t`, 0 <= from_t <= to_t <= 1. Where an
/// arc of several turns passes the place more than once as near (within 1 um), the first passage.
/// Lines and circles exactly; helices and spirals to within 0.1 um as long as they rise or grow by
/// less than a radius a turn.
PointOnWay nearest_on(const Motion& motion, const Vec3& place_mm, double from_t, double to_t = 1);

/// Axes A B C, which turn, and U V W, as a place has them.
struct TurnedAxes {
  std::array<double, 3> abc_deg{};
  std::array<bool, 3> counts{};  ///< false: not known, or not to be compared
  /// An axis that is off by an angle is off by the way of a point so far from its line. mm.
  double lever_mm = 0;
  Vec3 uvw_mm{0};
  std::array<bool, 3> uvw_counts{};
};

/// The same where these count, too: the distance is that of a place in nine dimensions. Exact for
/// lines, and for arcs on which none of them goes; else to within 1 um, as long as the place is
/// less than a radius from the way.
PointOnWay nearest_on(const Motion& motion, const Vec3& place_mm, const TurnedAxes& turned,
                      double from_t, double to_t = 1);

/// The part of a motion between two fractions of its way, 0 <= from_t <= to_t <= 1. With 0 and 1
/// the motion itself, bit for bit.
Motion part_of(const Motion& motion, double from_t, double to_t);

}  // namespace kerf
