// twin/kinematics/kinematics_setup.h - the kinematics of a user's machine: from its INI, its HAL
// files and the configuration.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "interp_bridge/ini_file.h"
#include "twin/kinematics/machine_kinematics.h"

namespace kerf {

/// What a configuration says of a machine's kinematics. It wins over INI and HAL.
struct KinematicsRequest {
  std::string kinematics;       ///< as [KINS]KINEMATICS; empty: that of the INI
  KinematicsGeometry geometry;  ///< mm, degrees
  std::optional<RotarySide> rotary_side;
  std::optional<Vec3> rotary_center_mm;
  /// Length of the tool as the module is told; not given: as HAL has it.
  std::optional<double> told_tool_mm;
};

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
/// known_machine().
Result<MachineKinematics> kinematics_of_ini(IniFile& ini, const std::string& folder,
                                            std::string_view joint_letters, double unit_mm,
                                            const KinematicsRequest& request);

/// Without an INI: what the configuration says; trivkins if it says nothing.
Result<MachineKinematics> kinematics_of_request(const KinematicsRequest& request,
                                                std::string_view joint_letters);

}  // namespace kerf
