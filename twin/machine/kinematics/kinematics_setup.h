// twin/machine/kinematics/kinematics_setup.h - the kinematics of a user's machine: from its INI,
// its HAL files and the configuration.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "interp_bridge/ini_file.h"
#include "twin/machine/kinematics/machine_kinematics.h"

namespace kerf {

/// A machine of the user's own: links that slide and turn, in place of a module.
struct LinkedKinematics {
  std::vector<ChainLink> links;
  std::string workpiece_on;  ///< Name of the link that carries the workpiece.
  std::string tool_on;       ///< Of the one whose origin holds the tool, which points along -Z.
  bool follows_tip = false;  ///< X Y Z are the tip on the workpiece (kTip); else kAxes
};

/// What a configuration says of a machine's kinematics. It wins over INI and HAL.
struct KinematicsRequest {
  std::string kinematics;                  ///< as [KINS]KINEMATICS; empty: that of the INI
  std::optional<LinkedKinematics> linked;  ///< instead of `kinematics`
  KinematicsGeometry geometry;             ///< mm, degrees
  std::optional<RotarySide> rotary_side;
  std::optional<Vec3> rotary_center_mm;
  /// Length of the tool as the module is told; not given: as HAL has it.
  std::optional<double> told_tool_mm;
  /// Values of HAL pins that the user tells ("xyzab_tdr_kins.x-offset", lower case), in the
  /// machine's units: for those that a running program sets. They go before what HAL files say.
  std::map<std::string, double> hal_pins;

  /// Does a configuration say anything of the kinematics? Pins alone do not.
  bool is_given() const {
    return !kinematics.empty() || linked || !geometry.empty() || rotary_side || rotary_center_mm ||
           told_tool_mm;
  }
};

/// Machine zero of a linked machine is where all its axes are at 0: X Y Z of the tool's origin as
/// the workpiece link sees it, less what they are there. `joint_letters` empty: an axis for each
/// that drives a link, in the order of XYZABCUVW (all nine where joints do). Error: as
/// KinematicChain::create(), or "the links do not slide along three directions ..".
Result<MachineKinematics> kinematics_of_links(const LinkedKinematics& linked,
                                              std::string_view joint_letters);

/// Whether nothing in the module says where its turning axes are: RotaryPlacement does.
bool takes_rotary_placement(std::string_view module);

/// The machine of an INI. Numbers that the module takes from HAL are looked for in the files that
/// [HAL]HALFILE, POSTGUI_HALFILE and HALCMD name, where they are written down: `setp PIN VALUE`,
/// `sets SIGNAL VALUE` with `net SIGNAL .. PIN`, and the sum of two such by sum2; VALUE may be
/// [SECTION]KEY. Tcl files and LIB: are not read, nor what a program computes while it runs. What
/// is not found is as the module has it when nobody sets it. In the same way it is found whether
/// the module is told the tool's length (motion.tooloffset.z), and which analog output switches its
/// kinematics.
///
/// `notes` of the result say where each number is from, and which side of the machine turns where
/// nothing says it. Lengths of the INI and of HAL are in units of `unit_mm`. Error: as
/// known_machine(), and numbers that the module does not take.
Result<MachineKinematics> kinematics_of_ini(IniFile& ini, const std::string& folder,
                                            std::string_view joint_letters, double unit_mm,
                                            const KinematicsRequest& request);

/// Without an INI: what the configuration says; trivkins if it says nothing.
Result<MachineKinematics> kinematics_of_request(const KinematicsRequest& request,
                                                std::string_view joint_letters);

}  // namespace kerf
