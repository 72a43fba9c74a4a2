// twin/cli/view_command.h - `kerf view`: a program, a log or a saved workpiece in a window.
#pragma once

#include <stop_token>

#include "twin/cli/run_options.h"
#include "twin/cli/view_options.h"

namespace kerf {

/// Opens the window at once and reads the program meanwhile. With --png or --frames there is no
/// window: the same renderer draws into files. Returns the exit code.
///
/// A window is all that is asked for: where there can be none, the command fails and names what
/// works without one (--png for a program, `kerf replay` for a log; `kerf replay` itself, which has
/// a report to make, goes on in the console). A log whose display is lost later is read to its end.
int view_command(const Arguments& arguments);

/// After a dry run: the program in a window, at its end; read again when its files change. Error:
/// there can be none. A program of standard input is shown as it was read.
int show_program(const Arguments& arguments, const RunRequest& request, std::stop_source& stop);

}  // namespace kerf
