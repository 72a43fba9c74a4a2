// twin/live/real_tip.h - where the tip of a watched machine is, and a program has it elsewhere.
#pragma once

#include "interp_bridge/motion.h"
#include "twin/live/program_ahead.h"

namespace kerf {

/// How the machine differs from the program at a place of it, and will go on to: by the tool in its
/// spindle, and by the tool length offset that its controller applies.
struct RealTip {
  int program_tool = -1;
  int tool = -1;            ///< in the spindle; -1: not known
  ToolLengthState program;  ///< the offset of the program there
  Vec3 shift_mm{0};         ///< of the tip, from where the program has it, under that offset
  /// .. and under another one: the machine will take it as the program has it, and it is that of
  /// another tool then.
  Vec3 tool_shift_mm{0};
  double length_mm = 0;  ///< of the tool, where it is shifted

  /// What comes of the two is the same.
  bool is_like(const RealTip& other) const;
};

/// All places of the motion, workpiece frame.
void move_tip(const Vec3& by_mm, Motion& motion);
/// The tip of a tool of that length is there; what has been wrong with the offset changes with it.
void move_real_tip(const Vec3& by_mm, double length_mm, Motion& motion);
/// Of a program's motion to come, before its next tool change.
void take_real_tip(const RealTip& tip, PlannedMotion& planned);

}  // namespace kerf
