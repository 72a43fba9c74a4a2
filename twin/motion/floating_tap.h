// twin/motion/floating_tap.h - taps in a chuck that floats: G84, G74.
#pragma once

#include "interp_bridge/motion.h"

namespace kerf {

/// Knows these cycles among the motions of a program, by what no other cycle does: right after the
/// traverse to its R, in the same block, they switch overrides off and feed along Z. Then the
/// spindle is reversed, and the tap fed out. Its chuck gives way to how far the feed is out of step
/// with the spindle: the thread has the pitch that both are meant for.
class FloatingTap {
 public:
  /// Of each motion, in program order. As CutMove::lead_mm: above 0 with M3; 0: it is no such feed.
  double lead_mm(const Motion& motion);

 private:
  SourceRef traverse_at_;  ///< of the motion before, if it was a traverse; else line 0
  bool is_in_ = false;     ///< fed in, at in_to_mm_
  SpindleState in_by_ = SpindleState::kStopped;
  Vec3 in_to_mm_{0};
};

}  // namespace kerf
