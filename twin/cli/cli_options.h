// twin/cli/cli_options.h - the options of the commands, as CLI11 knows them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "twin/config/written_options.h"

namespace kerf {

/// All that the setting table has for the command. What is parsed goes to `options`, which must
/// stay where it is.
void add_options(CLI::App& app, Command command, WrittenOptions& options);

/// The words of a command line with the values of options that are written without one
/// (Setting::fallback_if_bare): such an option takes the next word unless that begins with a dash
/// or is a file.
std::vector<std::string> with_bare_options(std::vector<std::string> words);

/// --help and --version in the language in force, for `app` and the commands that are added to it
/// from here on: CLI11 speaks English only. `version` is what --version prints.
void speak_language(CLI::App& app, const std::string& version);

/// What is wrong with a command line that CLI11 could not take.
std::string words_of(const CLI::ParseError& error);

}  // namespace kerf
