// twin/scene/drawn_machine.h - the machine around the workpiece, fitted to what it works on.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/diagnostic.h"
#include "base/geometry.h"
#include "twin/job/work_holding.h"
#include "twin/machines/machine_choice.h"
#include "twin/playback/program_track.h"
#include "viewer/scene.h"

namespace kerf {

/// What the machine has to go around.
struct WorkRoom {
  WorkpieceFrame frame;
  Box blank_mm;
  Box reach_mm;                    ///< of the tips; may be empty
  double tool_length_mm = 0;       ///< of the longest tool as it is drawn
  TurretPointer turret;            ///< of a punch press
  std::optional<ChuckRoom> chuck;  ///< chuck_room()
};

/// The room of a program: all its motions, and all its tools as tool_shape_of() draws them.
WorkRoom work_room(const ProgramTrack& track, const Box& blank_mm, double tool_length_mm);

/// Of a workpiece that turns: its chuck, if somebody described it.
std::optional<ChuckRoom> chuck_room(const HoldingList& held_by);

/// The machine that is chosen, or that the INI describes; null, without an error: there is no INI
/// and nothing is chosen, or none is wanted. `ini` empty: no INI.
std::shared_ptr<const MachineModel> drawn_machine(const MachineChoice& choice,
                                                  const std::string& ini, const WorkRoom& room,
                                                  Diagnostics& diagnostics);

/// What the viewer keeps of it.
SceneMachine scene_machine(const MachineModel& model);

/// From the tip to the highest point of the tool; of an insert, whose holder lies across, to the
/// one farthest along X.
double drawn_height_mm(const ToolShape& shape);
/// Of a tool on a lathe: where the turret holds it, along X or Z.
Vec3 held_from_tip(const ToolShape& shape);
/// So far the turret of the built-in lathe reaches towards the chuck, from its nose on; 0 of
/// others.
double before_turret_mm(const MachineModel& machine);

/// Poses of the links of a machine that stands so that the tool is seen from the workpiece as
/// `tool_in_workpiece` (its origin the tip). The slides are solved for; A, B and C are those of the
/// controller, with the signs that this machine has for them. Empty: it cannot stand so, since it
/// does not turn what the program turns.
std::vector<glm::mat4> drawn_poses(const MachineModel& machine, const Pose& tool_in_workpiece,
                                   const std::array<double, 3>& abc_deg, double tool_length_mm);

/// Poses of the machine's links for a tip and rotary axes of the program; `joints`: of links that
/// go by joints.
std::vector<glm::mat4> drawn_poses(const MachineModel& machine, const Vec3& tip_mm,
                                   const std::array<double, 3>& abc_deg, double tool_length_mm,
                                   const AxisValues& joints = {});

}  // namespace kerf
