// twin/cli/cli_options.h - the options of the commands, as CLI11 knows them.
#pragma once

#include <CLI/CLI.hpp>

#include "twin/config/written_options.h"

namespace kerf {

/// All that the setting table has for the command. What is parsed goes to `options`, which must
/// stay where it is.
void add_options(CLI::App& app, Command command, WrittenOptions& options);

}  // namespace kerf
