// twin/machines/machine_choice.h - which machine it is, if the user does not say.
#pragma once

#include <optional>
#include <string>

#include "twin/machine/kinematics/work_frame.h"
#include "twin/machine/machine_setup.h"
#include "twin/machines/builtin_models.h"
#include "twin/machines/linked_machine.h"

namespace kerf {

/// What tells kinds of machine apart.
struct MachineFacts {
  std::string kinematics = "trivkins";  ///< [KINS]KINEMATICS
  std::string joint_letters = "XYZ";
  MachineLimits limits;
  bool is_plasma = false;  ///< The INI has keys of QtPlasmaC.
};

/// Looks into the INI again for what MachineSetup does not hold; what is wrong with the file has
/// been said when it was read.
MachineFacts machine_facts(const MachineSetup& setup);

/// X or Y travels farther than this: a gantry, as tables do not.
inline constexpr double kLongestTableTravel_mm = 600.0;

/// In this order:
///   QtPlasmaC                                         plasma
///   X and Z, no Y                                     lathe
///   C with A or B, trivkins or kinematics with "trt"  trunnion
///   two joints on one axis, or more than
///   kLongestTableTravel_mm of travel in X or Y        gantry
///   5axiskins                                         bridge-mill
///   maxkins                                           swivel-mill
///   other kinematics whose slides are no X, Y, Z (robots, hexapods, ..)   none
///   else                                              knee-mill
MachineKind usual_machine_kind(const MachineFacts& facts);

/// `machine.model` and `machine.links` of a configuration. Links win; neither: as is usual.
struct MachineChoice {
  std::optional<MachineKind> kind;
  std::optional<LinkedMachine> links;

  bool is_chosen() const { return kind || links; }
};

/// check_shapes() of its links, if it has any.
void check_shapes(const MachineChoice& choice, Diagnostics& diagnostics);

/// A room with the machine's travels and its tilting axis. `setup` null: no INI.
MachineRoom machine_room(const MachineSetup* setup, const WorkpieceFrame& frame,
                         const Box& blank_mm, const Box& reach_mm, double tool_length_mm);

/// The machine to draw. Nothing, without an error: none is wanted. Errors as linked_machine() has
/// them.
std::optional<MachineModel> make_machine(const MachineChoice& choice, const MachineFacts& facts,
                                         const MachineRoom& room, Diagnostics& diagnostics);

}  // namespace kerf
