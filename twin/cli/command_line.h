// twin/cli/command_line.h - arguments as a line for a shell: what is shown to be copied.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "twin/config/written_options.h"
#include "twin/report/guess_row.h"

namespace kerf {

/// The command with what these arguments say, each word quoted where a POSIX shell needs it, in the
/// order of the setting table.
std::string command_line(const Arguments& arguments);
/// The words, each quoted where a POSIX shell needs it.
std::string command_line(const std::vector<std::string>& words);

/// The arguments, and what was guessed where they say nothing. `rows` in the unit of the arguments
/// (rows_in()).
Arguments with_guesses(Arguments arguments, std::span<const GuessRow> rows);

}  // namespace kerf
