// twin/machines/machine_model.h - a machine with its shape: its chain, a mesh for each link, and
// where the program's coordinates lie in it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/triangle_mesh.h"
#include "twin/machine/kinematics/kinematic_chain.h"

namespace kerf {

/// Part of a machine that moves as one: table, saddle, head.
struct LinkShape {
  std::string name;
  std::shared_ptr<const TriangleMesh> mesh;  ///< In the link's own frame.
  std::uint32_t color = 0xffa0a0a0;          ///< 0xAABBGGRR
};

/// Frames: `base` stands on the floor; each link has its own (chain). Machine zero is where the
/// origin of the tool link (the nose) is with all axes at 0; machine coordinates count from there.
///
///     base ... workpiece link <- workpiece (the program's frame, with the blank)
///         \... tool link      <- nose (its origin), and the tip a tool's length from it
struct MachineModel {
  std::string name;  ///< "knee mill"
  KinematicChain chain;
  std::vector<LinkShape> links;  ///< Of chain.links(), in this order; meshes in the link's frame.
  Pose link_from_workpiece;      ///< link_from_workpiece_of().
  Vec3 nose_from_tip{0.0, 0.0, 1.0};  ///< Unit vector in the tool link's frame; of a lathe +X.
};

/// Where a work offset puts the program's frame in the workpiece link.
Pose link_from_workpiece_of(const KinematicChain& chain, const Pose& machine_from_workpiece);

/// From each link to the workpiece frame. Reuses the memory of `out`.
void link_poses(const MachineModel& model, const MachinePosition& position,
                std::vector<glm::mat4>& out);

/// A tool in the workpiece frame.
struct ToolStand {
  Vec3 tip_mm{0.0};
  Vec3 axis{0.0, 0.0, 1.0};  ///< Unit length, from the tip to the spindle.
};
/// Of a tool of that length.
ToolStand tool_stand(const MachineModel& model, const MachinePosition& position,
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
