// twin/report/entry_modes.h - the modes at a line of a program, as words of a program, against
// those that LinuxCNC begins with.
#pragma once

#include <string>
#include <vector>

#include "interp_bridge/active_modes.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// A group of modes. Words are as a program says them: "G91", "G64 P0.05", "F300", "M3 S2000".
struct EntryMode {
  const char* name = "";   ///< of the report: "plane", "units", ..
  std::string now;         ///< at the line; empty: nothing of the group is in force
  std::string begins;      ///< what LinuxCNC begins with
  std::uint32_t line = 0;  ///< the line before that has made it so; 0: it began so
  /// LinuxCNC's "run from here" has it then. It hears of modes from the lines that it reads, and
  /// throws away what these lines would have told motion, tool changer, spindle and coolant
  /// (emctaskmain.cc: interp_list.clear(); emccanon.cc says what goes that way).
  bool is_kept = true;

  bool differs() const { return now != begins; }
  /// In force there by the program, and not after a start there.
  bool is_missed() const { return !is_kept && differs() && !now.empty(); }
};

/// The groups in the order in which they are told; empty, if `modes` is. What the program changes
/// from the line to `first`, its first motion, counts as kept: it says that by itself.
std::vector<EntryMode> entry_modes(const ActiveModes& modes, const Motion& first);

}  // namespace kerf
