// twin/live/reading.h - a sample of a machine that is watched, with what follows from it.
#pragma once

#include <array>

#include "base/geometry.h"
#include "machine_io/position_source.h"
#include "twin/live/path_follower.h"
#include "twin/machine/kinematics/pose.h"

namespace kerf {

/// A value. `place` is as PathMatcher left it: with the tool length that is in force, and from
/// PathMatcher::place_real_tip() on at the real tip.
struct Reading {
  ProgramPose place;  ///< under the kinematics in force
  Pose pose;          ///< of the tool in the workpiece
  double t_s = 0;     ///< since the first sample
  double tool_length_mm = 0;
  bool length_is_applied = false;  ///< SamplePose's
  bool by_length_before = false;   ///< it was found on the path by the length of the sample before
  /// Of it by the tool table. While the tip is on the program's path: as the program has it, unless
  /// tool and offset of the machine are others.
  Vec3 real_shift_mm{0};
  bool length_checked = false;  ///< SamplePose's
  int tool = -1;
  std::array<bool, 3> abc_known{};
  std::array<bool, 3> uvw_known{};
  bool restarted = false;  ///< the controller has, since the sighting before
  AxisSample sample;
};

}  // namespace kerf
