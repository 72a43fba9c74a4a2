// interp_bridge/kerf_interp/options.h - the command line of kerf-interp.
#pragma once

#include <optional>
#include <string>

#include "interp_bridge/kerf_interp/world.h"

namespace kerf::interp {

struct Options {
  std::string program;
  std::string startup;  ///< a block that is run first
  int answers_fd = -1;  ///< --answers
  int first_line = 0;   ///< --first-line; 0: the program is run from its beginning
  /// --there, workpiece coordinates, mm and degrees. Nothing: where the program is by then.
  std::optional<Pose> there;
  int records_fd = 3;
  /// --fast: plain numbers without a stream (fast_numbers.h), where that can be; kMust: or nothing.
  enum class Fast { kOn, kOff, kMust } fast = Fast::kOn;
};

/// Fills `options` and what it says about the machine. False: a fault, which has been printed.
bool read_options(int argc, char** argv, Options& options, World& world);

}  // namespace kerf::interp
