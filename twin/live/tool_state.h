// twin/live/tool_state.h - the tool after a sample, for views.
#pragma once

#include <array>
#include <string>

#include "base/geometry.h"
#include "interp_bridge/motion.h"
#include "twin/machine/kinematics/pose.h"

namespace kerf {

/// The machine now.
///
/// Between two samples the machine is taken to go as its controller interpolates: X Y Z straight
/// and A B C evenly, in the numbers of the kinematics in force (SamplePose). Without a program
/// these are those of the module's first type; of positions of joints the tool is where it is at
/// each sample whatever the type, and only the way between two depends on it.
struct ToolState {
  bool known = false;               ///< X, Y and Z were in the last sample
  Vec3 tip_mm{0};                   ///< workpiece frame: on the part, however that has turned
  bool turns = false;               ///< the model follows what turns, and so do these:
  Pose tool_pose;                   ///< of the tool there; its origin is tip_mm
  Vec3 spindle{0, 0, 1};            ///< there, from the tip to the nose
  Vec3 machine_mm{0};               ///< X Y Z as the machine has them
  std::array<double, 3> abc_deg{};  ///< as the program has them
  Vec3 uvw_mm{0};
  double spindle_rpm = 0;  ///< signed; NaN: not known
  int tool = -1;
  double tool_length_mm = 0;  ///< in force: from the tip to the spindle's nose
  bool followed = false;      ///< there is a program, and the tip is on its path
  bool in_corner = false;     ///< it is beside it, where the program lets a corner be rounded
  bool off_path = false;      ///< it should be, and is not
  double distance_mm = 0;     ///< from the path, if there is one
  SourceRef source;           ///< of the program's motion there
  double program_s = 0;       ///< program time, by the plan
  std::string missing_axes;   ///< why it is not known
  /// `source` and `program_s` are those of where it is now.
  bool has_program_place() const { return followed || in_corner; }
};

}  // namespace kerf
