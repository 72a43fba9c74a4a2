#include "twin/live/real_tip.h"

namespace kerf {

bool RealTip::is_like(const RealTip& other) const {
  if (shift_mm != other.shift_mm || tool_shift_mm != other.tool_shift_mm) return false;
  return shift_mm == tool_shift_mm || program == other.program;
}

void move_tip(const Vec3& by_mm, Motion& motion) {
  motion.from_mm += by_mm;
  motion.to_mm += by_mm;
  if (motion.kind == MotionKind::kArc) motion.arc.center_mm += by_mm;
}

void move_real_tip(const Vec3& by_mm, double length_mm, Motion& motion) {
  const Vec3 off_mm = motion.length.tip_shift_mm + by_mm;
  move_tip(by_mm, motion);
  motion.tool_offset_mm = {0, 0, length_mm};
  motion.length = {};
  if (off_mm == Vec3{0}) return;
  motion.length.verdict = ToolLengthState::Verdict::kWrong;
  motion.length.real_mm = {0, 0, length_mm};
  motion.length.applied_mm = motion.length.real_mm + off_mm;
  motion.length.tip_shift_mm = off_mm;
  motion.length.displaces = true;
}

void take_real_tip(const RealTip& tip, PlannedMotion& planned) {
  Motion& motion = planned.motion;
  if (motion.tool != tip.program_tool) return;
  if (tip.tool >= 0) motion.tool = tip.tool;
  const Vec3 by_mm = motion.length == tip.program ? tip.shift_mm : tip.tool_shift_mm;
  if (by_mm == Vec3{0}) return;
  move_real_tip(by_mm, tip.length_mm, motion);
  for (PathPiece& piece : planned.path) {
    piece.from_mm += by_mm;
    piece.to_mm += by_mm;
    if (piece.curved) piece.arc.center_mm += by_mm;
  }
}

}  // namespace kerf
