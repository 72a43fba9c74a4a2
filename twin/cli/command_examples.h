// twin/cli/command_examples.h - what --help and the manual pages show below the options.
#pragma once

#include "twin/config/setting_table.h"

namespace kerf {

/// Of the command, with a word before them where one is due; tr() shows it.
const char* examples_of(Command command);
/// Of kerf without a command.
const char* examples_of_kerf();

}  // namespace kerf
