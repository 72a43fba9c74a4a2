// Tips of tools whose length is not the offset in force: where they really are.
#include <cmath>

#include "base/portable_math.h"
#include "base/units.h"
#include "interp_bridge/motion_fold.h"

namespace kerf {

/// A vector along the machine's axes in the workpiece frame.
Vec3 MotionFold::along_work(const Vec3& v_mm) const {
  if (work_.rotation_deg == 0) return v_mm;
  const double angle = -work_.rotation_deg * kRadPerDeg;
  const double c = portable::cos(angle);
  const double s = portable::sin(angle);
  return {c * v_mm.x - s * v_mm.y, s * v_mm.x + c * v_mm.y, v_mm.z};
}

void MotionFold::follow_lengths(const CanonicalCommand& command, SourceRef source) {
  switch (command.name) {
    case CanonicalName::kUseToolLengthOffset: {
      const Vec3 before_mm = lengths_.applied_mm() - call_offset_mm_;
      lengths_.use(command, unit_mm_, source);
      call_offset_mm_ = tool_offset_mm_;
      const Vec3 unknown_mm = before_mm - (lengths_.applied_mm() - call_offset_mm_);
      if (!lengths_.is_hidden() || unknown_mm == Vec3{0} || !position_known_ || !height_said_)
        break;
      // The machine stands still: another number of the program is now where it is.
      if (!held_z_mm_) held_z_mm_ = program_from_work(position_mm_).z;
      held_at_ = source;
      position_mm_ += along_work(unknown_mm);
      position_as_printed_ = false;
      break;
    }
    case CanonicalName::kSetToolTableEntry:
      lengths_.set_row(command);
      break;
    case CanonicalName::kChangeTool:
    case CanonicalName::kChangeToolNumber:
      lengths_.mount(tool_, command.name == CanonicalName::kChangeToolNumber);
      break;
    default:
      break;
  }
}

/// Until the program names Z, it is where the machine happened to stand.
void MotionFold::note_height(const CanonicalCommand& command, bool known, double z_mm) {
  switch (command.name) {
    case CanonicalName::kStraightTraverse:
    case CanonicalName::kStraightFeed:
    case CanonicalName::kStraightProbe:
    case CanonicalName::kArcFeed:
    case CanonicalName::kRigidTap:
      break;
    default:
      return;
  }
  const double unnamed_mm =
      known ? z_mm : start_z_mm_ - frame_.g5x_mm.z - frame_.g92_mm.z - tool_offset_mm_.z;
  constexpr double kRounding_mm = 1e-6;
  height_said_ = std::abs(position_mm_.z - unnamed_mm) > kRounding_mm;
}

/// The same Z again may be written (G43 H2 Z50 behind another tool's Z50), or not (G49, G0 X0 Y0).
/// It is where nothing else moves, since something must; and in the block of G43.
void MotionFold::hold_height(const CanonicalCommand& command, SourceRef source, Vec3& to_mm) {
  const Vec3 at_mm = program_from_work(position_mm_);
  bool others =
      std::abs(to_mm.x - at_mm.x) > kSameLength_mm || std::abs(to_mm.y - at_mm.y) > kSameLength_mm;
  for (std::size_t i = 0; i < 3; ++i) others |= command.number(3 + i) != abc_deg_[i];
  const bool with_offset = source == held_at_ && lengths_.applied_mm() != Vec3{0};
  if (to_mm.z == *held_z_mm_ && others && !with_offset) {
    to_mm.z = at_mm.z;
  } else {
    held_z_mm_.reset();
  }
}

/// The fold itself goes by the program's places; here the motions behind `first` come to those of
/// the tip.
void MotionFold::place_tips(std::size_t first, std::vector<Motion>& out) const {
  ToolLengthState state = lengths_.state();
  if (state.verdict == ToolLengthState::Verdict::kSound || !height_said_) return;
  Vec3 error_mm{0};
  if (lengths_.displaces()) {
    error_mm = state.applied_mm - state.real_mm;
    state.tip_shift_mm = along_work(error_mm);
    state.displaces = true;
  }
  const Vec3 slid_mm = state.displaces ? state.uvw_off_mm : Vec3{0};
  for (std::size_t i = first; i < out.size(); ++i) {
    Motion& motion = out[i];
    motion.length = state;
    motion.from_mm += state.tip_shift_mm;
    motion.to_mm += state.tip_shift_mm;
    if (motion.kind == MotionKind::kArc) motion.arc.center_mm += state.tip_shift_mm;
    // The spindle follows the program's X.
    motion.surface.axis_x_mm += state.tip_shift_mm.x;
    motion.tool_offset_mm -= error_mm;
    motion.from_uvw_mm += slid_mm;
    motion.to_uvw_mm += slid_mm;
    motion.tool_offset_uvw_mm -= slid_mm;
  }
}

}  // namespace kerf
