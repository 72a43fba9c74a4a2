// twin/cli/program_options.h - the options about the program itself, which several commands share.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "interp_bridge/program.h"
#include "twin/cli/option_reader.h"
#include "twin/machine/kinematics/kinematics_setup.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// What is said of the program's machine otherwise than by an option.
struct ProgramSurroundings {
  /// Of a configuration (machine.kinematics, machine.joints), as read.
  std::optional<KinematicsRequest> kinematics;
  std::string joints;
  /// machine.work_offset of a configuration.
  std::optional<WorkpieceFrame> configured_offset;
  /// Values of HAL pins that are told; those of the kinematics are for these, too.
  std::map<std::string, double> hal_pins;
};

/// The options, understood.
struct ProgramRequest {
  ProgramOptions program;
  TimelineOptions timeline;
  std::string joint_letters;  ///< of the INI; empty: there is none
  /// Bits of the joints that count degrees, where INI or configuration say what the machine is.
  std::optional<std::uint16_t> turning_joints;
};

/// Where the work zero lies in the machine: the X, Y, Z of the command line in the place of the
/// configuration's; else the INI's parameter file may tell. Nothing: neither says it.
std::optional<WorkpieceFrame> understand_work_offset(const ProgramSurroundings& around,
                                                     OptionReader& reader);

/// Reads the INI, if one is given; the reader hears of its tool table. Faults go to the reader.
/// The program is followed by InterpreterSetup::unknown_places. `program`: the option that names
/// it.
ProgramRequest understand_program(std::string_view program, const ProgramSurroundings& around,
                                  OptionReader& reader);

/// "10,20,-5.5" as mm; nothing if it is not three lengths.
std::optional<Vec3> three_lengths(const std::string& text, LengthUnit unit);

}  // namespace kerf
