// twin/machine/machine_setup.h - the user's machine as its LinuxCNC INI describes it (--ini).
#pragma once

#include <cstdint>
#include <string>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "twin/machine/kinematics/kinematics_setup.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// What a dry run takes from an INI. Lengths in mm, whatever the machine's unit.
struct MachineSetup {
  /// Units, axes, start at home, parameter file, startup code, random tool changer, paths.
  InterpreterSetup interpreter;
  std::string tool_table_path;  ///< [EMCIO]TOOL_TABLE; empty: none
  TimelineOptions timeline;     ///< limits, their origin, servo and I/O periods
  std::string kinematics;       ///< [KINS]KINEMATICS: "trivkins"
  std::string lathe;            ///< ProgramOptions::lathe, by [DISPLAY]LATHE
  double spindle_max_rpm = 0;   ///< [SPINDLE_0]MAX_FORWARD_VELOCITY; 0: it says nothing
  std::string joint_letters;    ///< axis that each joint moves: "XYZ", "XYYZ"
  /// Bit n: joint n counts degrees. [JOINT_n]TYPE says so, else the machine's kinematics (of a
  /// robot joints turn that have the letters of X, Y and Z), else the letter.
  std::uint16_t turning_joints = 0;
};

/// Reads the INI at `path`. Relative paths in it are relative to its folder, as LinuxCNC (which
/// runs there) takes them. Limits of an axis come from [AXIS_L], else from [JOINT_n] of the joint
/// that moves it, unless that turns where the axis is a length (robots). All faults at once, with
/// line and column; false if there was an error. Keys of [TRAJ], [KINS], [EMCIO] and [RS274NGC]
/// that are not understood are notes.
///
/// Not read: [HAL], [APPLICATIONS] and all else that says how the machine is driven and shown. The
/// interpreter reads [RS274NGC], [EMCIO], [AXIS_*] and [PYTHON] itself (remaps, subroutine paths,
/// features).
///
/// `kinematics`: of the configuration, which wins; null: it says nothing of them.
bool read_machine_setup(const std::string& path, MachineSetup& setup, Diagnostics& diagnostics,
                        const KinematicsRequest* kinematics = nullptr);

}  // namespace kerf
