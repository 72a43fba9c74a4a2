// interp_bridge/kerf_interp/mode_watch.h - which lines have set the modes that are in force.
#pragma once

#include "interp_bridge/active_modes.h"
#include "interp_bridge/kerf_interp/recording.h"

namespace kerf::interp {

/// Asks the interpreter after each block, for a start in the middle of a program. Costs a few
/// hundred nanoseconds a block.
class ModeWatch {
 public:
  /// The program is open, and none of its blocks has been run.
  void begin(InterpBase& interpreter);
  /// A block has been run, which is of `line` of the program itself or called from there.
  void follow(InterpBase& interpreter, int line);
  /// A record of each group.
  void write(RecordWriter& records) const;

 private:
  ActiveModes modes_;
};

}  // namespace kerf::interp
