#include "twin/process/axis_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Programs have four decimals, offsets six: what lies beyond by less is at the limit.
constexpr double kTolerance = 1e-3;
constexpr double kArcStep_rad = 2 * kPi / 180;

}  // namespace

AxisLimitCheck::AxisLimitCheck(const MachineLimits& limits, FindingLog& log) : log_(log) {
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    limits_[i] = limits.axes[i];
    any_ |= limits_[i].present && (std::isfinite(limits_[i].min) || std::isfinite(limits_[i].max));
  }
}

void AxisLimitCheck::set_frame(const WorkpieceFrame& frame) {
  frame_ = frame;
  const double radians = frame.rotation_deg * kPi / 180;
  cos_ = frame.rotation_deg == 0 ? 1 : std::cos(radians);
  sin_ = frame.rotation_deg == 0 ? 0 : std::sin(radians);
}

void AxisLimitCheck::extend(Reach& reach, const Vec3& tip_mm, const Motion& m, bool first) const {
  const Vec3 p = tip_mm + frame_.g92_mm;
  const Vec3 machine = Vec3(cos_ * p.x - sin_ * p.y, sin_ * p.x + cos_ * p.y, p.z) + frame_.g5x_mm +
                       m.tool_offset_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = machine[static_cast<int>(i)];
    reach.min[i] = first ? value : std::min(reach.min[i], value);
    reach.max[i] = first ? value : std::max(reach.max[i], value);
  }
}

AxisLimitCheck::Reach AxisLimitCheck::reach_of(const Motion& m) const {
  Reach reach;
  extend(reach, m.to_mm, m, true);
  for (std::size_t i = 0; i < 3; ++i) {
    const double from = m.from_abc_deg[i] + frame_.offset_abc_deg[i];
    const double to = m.to_abc_deg[i] + frame_.offset_abc_deg[i];
    reach.min[3 + i] = m.start_known ? std::min(from, to) : to;
    reach.max[3 + i] = m.start_known ? std::max(from, to) : to;
    const auto axis = static_cast<int>(i);
    const double offset_mm = frame_.offset_uvw_mm[axis] + m.tool_offset_uvw_mm[axis];
    const double from_mm = m.from_uvw_mm[axis] + offset_mm;
    const double to_mm = m.to_uvw_mm[axis] + offset_mm;
    reach.min[6 + i] = m.start_known ? std::min(from_mm, to_mm) : to_mm;
    reach.max[6 + i] = m.start_known ? std::max(from_mm, to_mm) : to_mm;
  }
  if (!m.start_known) return reach;
  extend(reach, m.from_mm, m, false);
  if (m.kind != MotionKind::kArc) return reach;
  const bool level = std::abs(m.arc.axis.z) == 1;
  if (sin_ == 0 && cos_ == 1 && level) {
    const Box box = bounds_of(m);
    extend(reach, box.min, m, false);
    extend(reach, box.max, m, false);
    return reach;
  }
  const int steps = 1 + static_cast<int>(std::abs(m.arc.sweep_rad) / kArcStep_rad);
  for (int i = 1; i < steps; ++i) {
    extend(reach, point_at(m, static_cast<double>(i) / steps), m, false);
  }
  return reach;
}

void AxisLimitCheck::check(const Motion& m, const TimedStep& step) {
  if (!any_) return;
  switch (m.kind) {
    case MotionKind::kTraverse:
    case MotionKind::kFeed:
    case MotionKind::kArc:
    case MotionKind::kThread:
    case MotionKind::kProbe:
      break;
    case MotionKind::kDwell:
    case MotionKind::kToolChange:
    case MotionKind::kStop:
    case MotionKind::kProgramEnd:
    case MotionKind::kSignal:
      return;
  }
  const Reach reach = reach_of(m);
  // Under a rotation an unknown X or Y makes both so.
  const bool turned = sin_ != 0 && (m.unknown_to & 3) != 0;
  const unsigned unknown = turned ? m.unknown_to | 3U : m.unknown_to;
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
    if (axis < 3 && (unknown >> axis & 1) != 0) continue;
    check_axis(axis, reach, m, step);
  }
}

void AxisLimitCheck::check_axis(std::size_t axis, const Reach& reach, const Motion& m,
                                const TimedStep& step) {
  const AxisLimits& limit = limits_[axis];
  if (!limit.present) return;
  const double below = limit.min - reach.min[axis];
  const double above = reach.max[axis] - limit.max;
  const double beyond = std::max(below, above);
  if (!(beyond > kTolerance)) {
    events_[axis].reset();
    return;
  }
  if (events_[axis] && beyond <= events_[axis]->beyond) return;
  const char* unit = is_rotary_axis(axis) ? tr("degrees") : "mm";
  const double place = below > above ? reach.min[axis] : reach.max[axis];
  std::string text = trf(
      "axis {} is sent to {:.3f} {}, {:.3f} {} beyond its limit of {:.3f} {} (machine coordinates)",
      kAxisLetters[axis], place, unit, beyond, unit, below > above ? limit.min : limit.max, unit);
  if (events_[axis]) {
    log_.reword(events_[axis]->finding, std::move(text));
    events_[axis]->beyond = beyond;
    return;
  }
  Finding finding;
  finding.id = FindingId::kAxisLimit;
  finding.source = m.source;
  finding.time_s = step.start_s;
  finding.position_mm = m.to_mm;
  finding.text = std::move(text);
  events_[axis] = Event{log_.add(std::move(finding)), beyond};
}

}  // namespace kerf
