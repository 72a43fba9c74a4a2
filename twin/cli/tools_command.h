// twin/cli/tools_command.h - `kerf tools`: the shapes, the holders, the tools of a library.
#pragma once

#include "twin/config/written_options.h"

namespace kerf {

/// The exit code. Of a library: kExitUsage where it cannot be read; tools in it that are not
/// understood are listed, and no failure.
int tools_command(const Arguments& arguments);

}  // namespace kerf
