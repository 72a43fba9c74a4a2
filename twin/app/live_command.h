// twin/app/live_command.h - `kerf shadow` and `kerf replay`.
#pragma once

#include "twin/app/live_options.h"

namespace kerf {

/// Opens the source, watches it until it ends or somebody stops, writes what was asked for. Returns
/// the exit code.
int live_command(const LiveArguments& arguments, LiveCommand command);

}  // namespace kerf
