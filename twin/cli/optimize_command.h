// twin/cli/optimize_command.h - kerf optimize: a program with the feeds that its cuts allow.
#pragma once

#include "twin/config/written_options.h"

namespace kerf {

/// The exit code.
int optimize_command(const Arguments& arguments);

}  // namespace kerf
