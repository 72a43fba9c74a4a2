// twin/app/cli_options.h - the options of the commands, as CLI11 knows them.
#pragma once

#include <CLI/CLI.hpp>

#include "twin/app/canon_command.h"
#include "twin/app/live_options.h"
#include "twin/app/run_options.h"
#include "twin/app/view_command.h"

namespace kerf {

void add_run_options(CLI::App& run, RunArguments& arguments);
void add_view_options(CLI::App& view, ViewArguments& arguments);
void add_canon_options(CLI::App& canon, CanonArguments& arguments);
void add_live_options(CLI::App& live, LiveArguments& arguments, LiveCommand command);

}  // namespace kerf
