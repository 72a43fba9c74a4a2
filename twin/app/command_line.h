// twin/app/command_line.h - arguments as a line for a shell.
#pragma once

#include <string>

#include "twin/app/view_options.h"

namespace kerf {

/// `kerf view` with what these arguments say, each word quoted where a POSIX shell needs it.
std::string command_line(const ViewArguments& arguments);

}  // namespace kerf
