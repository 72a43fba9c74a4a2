// twin/app/program_options.h - the options about the program itself, which several commands share.
#pragma once

#include <string>

#include "interp_bridge/program.h"
#include "twin/app/option_reader.h"
#include "twin/timeline.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct ProgramArguments {
  std::string program;
  std::string ini;
  std::string tool_table;
  std::string interp;
  std::string block_delete;
  std::string max_commands;
  std::string max_seconds;
};

/// The same, understood.
struct ProgramRequest {
  ProgramOptions program;
  TimelineOptions timeline;
  std::string joint_letters;  ///< of the INI; empty: there is none
};

/// Reads the INI, if one is given. Faults go to the reader.
ProgramRequest understand_program(const ProgramArguments& arguments, OptionReader& reader);

}  // namespace kerf
