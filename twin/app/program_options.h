// twin/app/program_options.h - the options about the program itself, which several commands share.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "interp_bridge/program.h"
#include "twin/app/option_reader.h"
#include "twin/kinematics/kinematics_setup.h"
#include "twin/timeline.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct ProgramArguments {
  std::string program;
  std::string ini;
  std::string tool_table;
  std::string interp;
  std::string block_delete;
  std::string work_offset;  ///< X,Y,Z
  std::string units;        ///< of lengths that options give, and of what is shown: mm, inch
  std::string max_commands;
  std::string max_seconds;
  std::string max_cpu_seconds;
  bool as_mill = false;
  /// Of a configuration (machine.kinematics, machine.joints), as read.
  std::optional<KinematicsRequest> kinematics;
  std::string joints;
  /// machine.work_offset of a configuration.
  std::optional<WorkpieceFrame> configured_offset;
  /// Values of HAL pins that are told; those of the kinematics are for these, too.
  std::map<std::string, double> hal_pins;
};

/// The same, understood.
struct ProgramRequest {
  ProgramOptions program;
  TimelineOptions timeline;
  std::string joint_letters;  ///< of the INI; empty: there is none
  /// Bits of the joints that count degrees, where INI or configuration say what the machine is.
  std::optional<std::uint16_t> turning_joints;
};

/// Where the work zero lies in the machine: the X, Y, Z of the command line come before those of
/// the configuration, which comes before what the INI's parameter file has. Nothing: neither says
/// it.
std::optional<WorkpieceFrame> understand_work_offset(const ProgramArguments& arguments,
                                                     OptionReader& reader);

/// Reads the INI, if one is given. Faults go to the reader. The program is followed by
/// InterpreterSetup::unknown_places.
ProgramRequest understand_program(const ProgramArguments& arguments, OptionReader& reader);

}  // namespace kerf
