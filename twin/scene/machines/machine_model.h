// twin/scene/machines/machine_model.h - a machine to look at: its chain, a mesh for each link, and
// where the program's coordinates lie in it. What the viewer is given comes from here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/machine/kinematics/kinematic_chain.h"
#include "viewer/scene.h"

namespace kerf {

/// Frames: `base` stands on the floor; each link has its own (chain). Machine zero is where the
/// origin of the tool link (the nose) is with all axes at 0; machine coordinates count from there.
///
///     base ... workpiece link <- workpiece (the program's frame, with the blank)
///         \... tool link      <- nose (its origin), and the tip a tool's length from it
struct MachineModel {
  std::string name;  ///< "knee mill"
  KinematicChain chain;
  std::vector<MachineLink> links;  ///< Of chain.links(), in this order; meshes in the link's frame.
  Pose link_from_workpiece;        ///< link_from_workpiece_of().
  Vec3 nose_from_tip{0.0, 0.0, 1.0};  ///< Unit vector in the tool link's frame; of a lathe +X.
};

/// Where a work offset puts the program's frame in the workpiece link.
Pose link_from_workpiece_of(const KinematicChain& chain, const Pose& machine_from_workpiece);

/// What the viewer keeps.
SceneMachine scene_machine(const MachineModel& model);

/// For Moment::link_poses: from each link to the workpiece frame. Reuses the memory of `out`.
void link_poses(const MachineModel& model, const MachinePosition& position,
                std::vector<glm::mat4>& out);

/// Tip and axis of a tool of that length in the workpiece frame.
ToolPose tool_pose(const MachineModel& model, const MachinePosition& position,
                   double tool_length_mm);

/// Machine position for what a program has for axes under its work offset, X Y Z being those of the
/// tip. Trivial kinematics: every axis by itself, so a table that turns takes the part away from
/// under X Y Z. Joints are not set.
MachinePosition position_of_axes(const MachineModel& model, const AxisValues& program,
                                 double tool_length_mm);

/// Machine position that puts the tip on a point of the (turned) workpiece, as kinematics that
/// follow the tip do (G43.4, xyzac-trt-kins): A B C U V W as in `program`, X Y Z solved for. Any
/// serial chain in which X, Y and Z slide. Of a machine without Y (a lathe) the nearest point.
/// Nothing if the slides do not span the way: two of them are parallel, or there is none.
std::optional<MachinePosition> position_of_tip(const MachineModel& model, const AxisValues& program,
                                               double tool_length_mm);

}  // namespace kerf
