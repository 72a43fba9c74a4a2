// twin/cli/mcp_command.h - `kerf mcp`: dry runs as tools of a client of the Model Context Protocol.
#pragma once

#include "twin/config/written_options.h"

namespace kerf {

/// Serves standard input and output until the client closes its end, or until a signal. The exit
/// code.
int mcp_command(const Arguments& arguments);

}  // namespace kerf
