// twin/machine/kinematics/arc_bounds.h - how fast and how sharply a motion's tip goes, at most.
#pragma once

#include "interp_bridge/motion.h"

namespace kerf {

/// Bounds of the derivatives of point_at() in t over [0, 1], absolute. mm.
struct ArcBounds {
  double speed = 0, acceleration = 0, jerk = 0;
};

/// Of an arc (a helix, a spiral).
ArcBounds arc_bounds(const Motion& motion);

/// It goes round; straight ones have no acceleration.
bool is_arc(const Motion& motion);

}  // namespace kerf
