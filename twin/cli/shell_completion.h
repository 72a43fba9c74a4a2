// twin/cli/shell_completion.h - what makes a shell complete the command lines of kerf, from the
// setting table: commands, options, words, files, keys after --set.
#pragma once

#include <string>

namespace kerf {

/// To be sourced by bash 4.4 or later, or laid into bash-completion's folder as `kerf`.
std::string bash_completion();

/// To be laid into a folder of zsh's fpath as `_kerf`, or sourced after compinit.
std::string zsh_completion();

}  // namespace kerf
