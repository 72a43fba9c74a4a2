// twin/machine/kinematics/machine_kinematics.h - what a controller makes of the axes: the
// kinematics that [KINS]KINEMATICS names, its types, and the chain of links that it moves.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "interp_bridge/motion.h"
#include "twin/machine/kinematics/known_kinematics.h"

namespace kerf {

/// What the numbers of a program mean to the machine.
enum class KinematicsMode : std::uint8_t {
  /// Every axis moves its joint: a table that turns carries the part away from under X Y Z.
  kAxes,
  /// X Y Z are the controlled point as seen from the workpiece, A B C (U V W) their joints: where a
  /// table turns, X Y Z follow ("tool centre point", G43.4 of other controllers).
  kTip,
  /// The same of a robot: A B C are roll, pitch and yaw of the flange, and no joint's.
  kArm,
};

/// No module has more types.
inline constexpr std::size_t kMostKinematicsTypes = 3;

/// One of the kinematics that a module can be switched to (motion.switchkins-type).
struct KinematicsType {
  std::string name;  ///< "identity", "userk", or that of the module
  KinematicsMode mode = KinematicsMode::kAxes;
  /// kAxes: axis i of the machine is sign[i] * program[source[i]]. Other than i only where a mill
  /// turns into a lathe (millturn).
  std::array<std::uint8_t, kAxisCount> source{0, 1, 2, 3, 4, 5, 6, 7, 8};
  std::array<std::int8_t, kAxisCount> sign{1, 1, 1, 1, 1, 1, 1, 1, 1};
};

/// Numbers that a module takes as HAL pins, by the pins' names without the module's: mm, degrees
/// ("y-offset", "pivot-length", "D4"). "ALPHA-0" .. of genserkins are radians, as there.
using KinematicsGeometry = std::map<std::string, double, std::less<>>;

/// One such pin, with what the module takes if nobody sets it.
struct GeometryPin {
  std::string name;
  double standard = 0;
};

/// Where the turning axes of a machine are whose kinematics do not say so (trivkins, corexykins,
/// gantrykins, millturn).
struct RotaryPlacement {
  RotarySide side = RotarySide::kTable;
  Vec3 center_mm{0.0};  ///< The lines that they turn about meet here, machine coordinates.
};

/// A machine as its controller knows it. Values: all members are what they say, and copies are
/// independent.
///
///     program (offsets added) --type--> machine axes --joint_letters--> joints
///                                            \--chain--> tool seen from the workpiece
struct MachineKinematics {
  std::string module;         ///< "xyzac-trt-kins"
  std::string joint_letters;  ///< Axis of each joint, "XYYZ"; of a robot those of `identity`.
  bool belts = false;         ///< corexykins: joints 0 and 1 are X + Y and X - Y.
  KinematicChain chain;       ///< Driven by machine axes, of a robot by joints.
  std::vector<KinematicsType> types;  ///< [motion.switchkins-type]; 1 .. kMostKinematicsTypes.
  /// Analog output that motion.switchkins-type hangs on: M68 E3 Q.., as LinuxCNC's M428, M429 and
  /// M430 have it. 0 .. 3.
  unsigned switch_output = 3;
  /// Unit vector from the tip towards the nose, frame of the chain's tool link (of a robot: of its
  /// flange).
  Vec3 nose_from_tip{0.0, 0.0, 1.0};
  /// kArm: the flange's frame at rest, and the axes that turn it, the outermost first.
  glm::dmat3 flange_at_rest{1.0};
  std::string arm_turns = "CBA";
  double pivot_length_mm = 0;  ///< from the controlled point up to it; 0: no such pin
  /// The chain's slides of U, V and W are in the module's mind only (5axiskins, maxkins): their
  /// joints have no motors, and X Y Z go in their place, so that the tool moves along its own axes.
  /// W-10 is 10 mm deeper along a tool that leans. False: such slides are there, and what they
  /// carry moves; where the module follows the tip the tool stays where it is.
  bool uvw_by_xyz = false;
  /// Length of the tool as the module is told: not given = that of G43, whatever it is (HAL nets
  /// motion.tooloffset.z to it). Matters in kTip alone.
  std::optional<double> told_tool_mm;
  std::vector<std::string> notes;  ///< What was assumed; one sentence each.

  /// The type of that number; the first one if there is none.
  const KinematicsType& type(int number) const;
  /// Number of the type in force during a motion; 0 at the start of a program.
  int type_of(const Motion& motion) const;
  bool is_switchable() const { return types.size() > 1; }
  /// Does any type turn the tool or the workpiece? (Does A, B or C exist?)
  bool turns() const;
  /// Does U, V or W move the tool, or the workpiece under it?
  bool slides_uvw() const;
  /// The same machine while nothing turns: A, B and C stand at 0. Not of robots.
  MachineKinematics standing() const;
  /// A robot: some type is kArm. Its chain is driven by joints.
  bool is_arm() const;
  /// The joint counts degrees: it turns a link of the chain, or its axis is A, B or C.
  bool turns_joint(std::size_t joint) const;

  /// Forward, as the module does it: the axes for these joints. `tool_mm`: as told_tool_mm, for a
  /// tool offset of that length. A B C of a robot: roll, pitch, yaw in -180 .. 180.
  AxisValues axes_of(const AxisValues& joints, int type_number, double tool_mm = 0) const;
  /// Inverse: where the machine is sent. Nothing of robots (kArm), and where slides are parallel.
  std::optional<MachinePosition> position_of(const AxisValues& axes, int type_number,
                                             double tool_mm = 0) const;
  /// Length that the module reckons with under this tool offset.
  double told_tool(double tool_offset_mm) const { return told_tool_mm.value_or(tool_offset_mm); }
};

/// Modules that known_machine() understands, for messages.
std::vector<std::string> known_modules();
/// Pins of a module; empty for those without, and for unknown ones.
std::vector<GeometryPin> geometry_pins(std::string_view module);

/// The machine of `kinematics` = "MODULE [coordinates=..] [sparm=identityfirst] ..". What
/// `geometry` does not hold is as the module has it when nobody sets its pins. `joint_letters`: of
/// the INI
/// ([TRAJ]COORDINATES), for modules that take any; `coordinates=` wins. Error: a module that moves
/// no serial chain ("tripodkins is no serial chain .."), with those that are known.
Result<MachineKinematics> known_machine(std::string_view kinematics, std::string_view joint_letters,
                                        const KinematicsGeometry& geometry,
                                        const RotaryPlacement& placement);

}  // namespace kerf
