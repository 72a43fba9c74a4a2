// twin/app/command_line.h - arguments as a line for a shell: what is shown to be copied.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "twin/app/run_options.h"
#include "twin/app/view_options.h"
#include "twin/guess/guess_row.h"

namespace kerf {

/// `kerf run` and `kerf view` with what these arguments say, each word quoted where a POSIX shell
/// needs it.
std::string command_line(const RunArguments& arguments);
/// The words, each quoted where a POSIX shell needs it.
std::string command_line(const std::vector<std::string>& words);
std::string command_line(const ViewArguments& arguments);

/// The arguments, and what was guessed where they say nothing. `rows` in the unit of the arguments
/// (rows_in()).
RunArguments with_guesses(RunArguments arguments, std::span<const GuessRow> rows);

}  // namespace kerf
