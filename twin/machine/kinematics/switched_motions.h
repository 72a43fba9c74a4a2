// twin/machine/kinematics/switched_motions.h - the motions of a program that switches its machine's
// kinematics, as the machine makes them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "interp_bridge/motion.h"
#include "twin/machine/kinematics/tool_path.h"

namespace kerf {

/// When a program switches kinematics (M428 to M430 of LinuxCNC's samples) while the machine stands
/// turned, the machine stays where it is, and X Y Z are other numbers from there on
/// (ToolPath::take_up). LinuxCNC waits and takes the new numbers for its own; the interpreter that
/// runs without a machine goes on with the old ones. Here the motions get the right ones:
///
///     from_mm   where the machine is
///     to_mm     an axis that the motion does not move, by the interpreter's numbers, stays where
///               it is: its word is not there. (A word that repeats the old number is taken for
///               one that is not there.)
///
/// An axis that a motion moves is where the program says from then on. Arcs right after the switch
/// are left as they are: their centre says where they begin.
class SwitchedMotions {
 public:
  /// Null, or a machine with one type of kinematics: nothing is ever changed, and it costs nothing.
  explicit SwitchedMotions(std::shared_ptr<const MachineKinematics> machine);

  /// In program order, with the frame in force. The same motions where none is changed, else
  /// copies, valid until the next call.
  std::span<const Motion> follow(std::span<const Motion> motions, const WorkpieceFrame& frame);

 private:
  bool changes(Motion& motion);

  std::shared_ptr<const MachineKinematics> machine_;  ///< null: none that is switched
  WorkpieceFrame frame_;
  std::optional<ToolPath> path_;
  std::optional<Motion> before_;  ///< the last that moved, as the machine made it
  std::array<bool, 3> adrift_{};  ///< X, Y, Z are not what the interpreter has
  std::vector<Motion> copies_;
};

}  // namespace kerf
