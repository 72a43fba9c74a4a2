#include "twin/motion/floating_tap.h"

#include <utility>

#include "interp_bridge/motion_kinds.h"

namespace kerf {

double FloatingTap::lead_mm(const Motion& m) {
  if (!is_move(m)) return 0;
  const SourceRef traverse_at =
      std::exchange(traverse_at_, is_traverse(m) ? m.source : SourceRef{});
  const bool was_in = std::exchange(is_in_, false);
  const bool along_z = m.from_mm.x == m.to_mm.x && m.from_mm.y == m.to_mm.y;
  if (m.kind != MotionKind::kFeed || !m.start_known || !along_z) return 0;
  if (m.spindle == SpindleState::kStopped || !(m.spindle_rpm > 0)) return 0;
  if (m.to_mm.z < m.from_mm.z) {
    const bool is_cycle = traverse_at.line > 0 && traverse_at == m.source &&
                          m.chain_end == ChainEnd::kEnds && m.halts == 0;
    if (!is_cycle) return 0;
    is_in_ = true;
    in_by_ = m.spindle;
    in_to_mm_ = m.to_mm;
  } else if (!was_in || m.from_mm != in_to_mm_ || m.spindle == in_by_) {
    return 0;
  }
  const double pitch_mm = m.feed_per_rev ? m.feed_mm_per_min : m.feed_mm_per_min / m.spindle_rpm;
  return m.spindle == SpindleState::kClockwise ? pitch_mm : -pitch_mm;
}

}  // namespace kerf
