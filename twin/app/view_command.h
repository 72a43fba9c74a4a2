// twin/app/view_command.h - `kerf view`: a program, a log or a saved workpiece in a window.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "twin/app/live_options.h"
#include "twin/app/run_options.h"

namespace kerf {

/// The arguments as written. Empty = not given.
struct ViewArguments {
  std::string config;
  std::vector<std::string> sets;
  RunArguments run;  ///< run.source.program is PROGRAM, LOG or STATE
  std::string speed;
  std::string at_line;
  std::string keyframes;
  std::string png;
  std::string frames;
  std::string fps;
  std::string size;
  std::string view;
  std::string draw;
  std::string compare;
  std::string tolerance;
  bool no_local = false;
};

/// Opens the window at once and reads the program meanwhile. With --png or --frames there is no
/// window: the same renderer draws into files. Returns the exit code.
int view_command(const ViewArguments& arguments);

/// After a dry run: the program in a window, at its end. Error: there can be none.
int show_program(const RunRequest& request, std::stop_source& stop);

}  // namespace kerf
