#include "twin/process/punch/punch_holds.h"

#include <algorithm>
#include <utility>

#include "base/translate.h"

namespace kerf {

PunchHolds::PunchHolds(TurretPointer turret)
    : turret_(std::move(turret)), moves_(turret_), clamps_(turret_) {}

MotionHold PunchHolds::of(const Motion& m) {
  const PunchTimes& times = turret_->times;
  MotionHold hold;
  hold.moves = goes_somewhere(m);
  recent_[taken_ % recent_.size()] = m;
  hits_.clear();
  moves_.hits(
      taken_++, [this](std::size_t n) -> const Motion& { return recent_[n % recent_.size()]; },
      hits_);
  if (clamps_.follow(m)) (goes_somewhere(m) ? hold.before : hold.after).regrip_s = times.regrip_s;
  if (m.kind == MotionKind::kToolChange && m.tool > 0) {
    hold.after.turret_s = times.change_s(station_, m.tool);
  }
  if (m.tool > 0) station_ = m.tool;
  if (!hits_.empty()) add_strokes(m, hold);
  return hold;
}

void PunchHolds::add_strokes(const Motion& m, MotionHold& hold) {
  const PunchTimes& times = turret_->times;
  if (moves_.nibbles(m)) {
    if (times.stroke_s <= 0 && times.period_by_pitch_s.empty()) return;
    row_.clear();
    for (const PunchHit& hit : hits_) row_.push_back(hit.share);
    hold.row = row_;
    return;
  }
  for (const PunchHit& hit : hits_) {
    const bool at_start = hit.share <= 0 && goes_somewhere(m);
    (at_start ? hold.before : hold.after).strokes_s += times.stroke_s;
  }
}

double PunchHolds::stroke_s(double pitch_mm, double move_s) const {
  const PunchTimes& times = turret_->times;
  const double period_s = pitch_mm > 0 ? times.period_s(pitch_mm) : 0;
  return std::max(times.stroke_s, period_s - move_s);
}

std::string PunchHolds::text() const {
  const PunchTimes& times = turret_->times;
  if (!times.any()) {
    return trf("; strokes, turret and re-gripping no time ({} has no times)", turret_->path);
  }
  std::string out = trf("; a stroke {:g} s", times.stroke_s);
  if (!times.period_by_pitch_s.empty()) {
    const auto& [pitch_mm, period_s] = *times.period_by_pitch_s.begin();
    out += trf(", nibbling at most {:g} a minute at {:g} mm", 60 / period_s, pitch_mm);
  }
  return out + trf(", the turret {:g} s a change and {:g} s a place, re-gripping {:g} s",
                   times.lock_s, times.step_s, times.regrip_s);
}

}  // namespace kerf
