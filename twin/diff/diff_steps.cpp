#include "twin/diff/diff_steps.h"

#include "interp_bridge/motion_kinds.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {

bool has_way(const DiffStep& step) { return is_move(step.kind) && step.start_known; }

Motion motion_of(const DiffStep& step) {
  Motion m;
  m.kind = step.kind;
  m.rapid = step.rapid;
  m.from_mm = step.from_mm;
  m.to_mm = step.to_mm;
  m.from_abc_deg = step.from_abc_deg;
  m.to_abc_deg = step.to_abc_deg;
  m.from_uvw_mm = step.from_uvw_mm;
  m.to_uvw_mm = step.to_uvw_mm;
  m.arc = step.arc;
  return m;
}

void StepCollector::on_step(std::uint64_t /*number*/, const Motion& m, const TimedStep& /*step*/) {
  const bool turns_or_slides = m.from_abc_deg != m.to_abc_deg || m.from_uvw_mm != m.to_uvw_mm;
  if (is_move(m) && m.start_known && stands_still(m) && !turns_or_slides) return;
  DiffStep& step = steps.emplace_back();
  step.kind = m.kind;
  step.rapid = m.rapid;
  step.start_known = m.start_known;
  step.unknown_to = m.unknown_to;
  step.source = m.source;
  step.from_mm = m.from_mm;
  step.to_mm = m.to_mm;
  step.from_abc_deg = m.from_abc_deg;
  step.to_abc_deg = m.to_abc_deg;
  step.from_uvw_mm = m.from_uvw_mm;
  step.to_uvw_mm = m.to_uvw_mm;
  if (m.kind == MotionKind::kArc) step.arc = m.arc;
  step.dwell_s = m.kind == MotionKind::kDwell ? m.duration_s : 0;
  step.tool = m.tool;
  step.feed = is_feed(m) || m.kind == MotionKind::kProbe ? m.feed_mm_per_min : 0;
  step.feed_per_rev = step.feed > 0 && m.feed_per_rev;
  step.spindle = m.spindle;
  step.rpm = m.spindle == SpindleState::kStopped || m.surface.on() ? 0 : m.spindle_rpm;
  step.surface_mm_per_min = m.spindle == SpindleState::kStopped ? 0 : m.surface.mm_per_min;
  step.flood = m.flood;
  step.mist = m.mist;
  step.torch = m.torch;
}

}  // namespace kerf
