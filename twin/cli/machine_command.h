// twin/cli/machine_command.h - `kerf machine`: starts kerf-machine, the simulated machine.
#pragma once

namespace kerf {

/// Replaces this process by the kerf-machine beside it (or in ../lib/kerf, or in PATH): kerf itself
/// holds no code that could write to a bus. `argv[0]` is "machine". Returns, with an exit code,
/// only if there is none.
int machine_command(int argc, char** argv);

}  // namespace kerf
