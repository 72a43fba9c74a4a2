// twin/machine/kinematics/work_frame.h - where a program's coordinates lie in the machine.
#pragma once

#include "interp_bridge/motion.h"
#include "twin/machine/kinematics/pose.h"

namespace kerf {

/// From the workpiece frame to machine coordinates (of the tip). LinuxCNC turns about the origin of
/// the G5x system; G92 is a shift within it.
inline Pose machine_from_workpiece(const WorkpieceFrame& frame) {
  Pose pose = turn({0, 0, 1}, frame.rotation_deg);
  pose.origin_mm = frame.g5x_mm + pose.direction(frame.g92_mm);
  return pose;
}

}  // namespace kerf
