// twin/process/check_options.h - what findings are judged by.
#pragma once

#include <cstdint>

namespace kerf {

/// What findings are judged by.
struct CheckOptions {
  bool blank_guessed = false;
  /// How far below the floor of the blank the tip may go: into a spoilboard. mm.
  double below_mm = 0;
  /// The blank is a skin that was guessed over the only level that is fed, and the program never
  /// starts a spindle: a pen, a knife. What stands in that skin is no fault.
  bool is_drawn = false;
};

/// Where the blank of a run comes from, and so what it means that nothing of it is cut.
enum class BlankKind : std::uint8_t {
  kUnjudged,  ///< a part of a program, a machine that is watched: nothing is said
  kGiven,     ///< by the user or by the program
  kGuessed,   ///< from the moves
  kSaved,     ///< a workpiece that has been cut before: a second pass may find nothing
};

}  // namespace kerf
