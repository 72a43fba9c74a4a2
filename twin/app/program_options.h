// twin/app/program_options.h - the options about the program itself, which several commands share.
#pragma once

#include <string>

#include "interp_bridge/program.h"
#include "twin/app/option_reader.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct ProgramArguments {
  std::string program;
  std::string tool_table;
  std::string interp;
  std::string block_delete;
  std::string max_commands;
  std::string max_seconds;
};

/// The same, understood; faults go to the reader.
ProgramOptions understand_program(const ProgramArguments& arguments, OptionReader& reader);

}  // namespace kerf
