#include "twin/program_holds.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "twin/motion_geometry.h"

namespace kerf {
namespace {

bool goes_somewhere(const Motion& m) {
  if (m.kind != MotionKind::kTraverse && m.kind != MotionKind::kProbe && !is_feed(m)) return false;
  const bool turns = m.kind == MotionKind::kArc && m.arc.sweep_rad != 0;
  return turns || m.from_mm != m.to_mm || m.from_abc_deg != m.to_abc_deg ||
         m.from_uvw_mm != m.to_uvw_mm;
}

}  // namespace

HeldTime& HeldTime::operator+=(const HeldTime& other) {
  strokes_s += other.strokes_s;
  turret_s += other.turret_s;
  regrip_s += other.regrip_s;
  pierces_s += other.pierces_s;
  pauses_s += other.pauses_s;
  return *this;
}

HoldOptions holds_of(const TurretPointer& turret, const std::optional<BeamSettings>& beam) {
  HoldOptions holds;
  holds.turret = turret;
  if (!turret && beam && beam->is_qtplasmac) holds.torch = beam->trigger;
  return holds;
}

ProgramHolds::ProgramHolds(HoldOptions options) : options_(std::move(options)) {
  if (!options_.turret) return;
  punch_.emplace(options_.turret);
  clamps_.emplace(options_.turret);
}

void ProgramHolds::set_materials(std::span<const TorchMaterial> materials) {
  materials_.assign(materials.begin(), materials.end());
}

MotionHold ProgramHolds::of(const Motion& m) {
  MotionHold hold = options_.turret ? of_punch(m) : options_.torch ? of_torch(m) : MotionHold{};
  hold.moves = goes_somewhere(m);
  return hold;
}

MotionHold ProgramHolds::of_punch(const Motion& m) {
  const PunchTimes& times = options_.turret->times;
  MotionHold hold;
  recent_[taken_ % recent_.size()] = m;
  hits_.clear();
  punch_->hits(
      taken_++, [this](std::size_t n) -> const Motion& { return recent_[n % recent_.size()]; },
      hits_);
  if (clamps_->follow(m)) (goes_somewhere(m) ? hold.before : hold.after).regrip_s = times.regrip_s;
  if (m.kind == MotionKind::kToolChange && m.tool > 0) {
    hold.after.turret_s = times.change_s(station_, m.tool);
  }
  if (m.tool > 0) station_ = m.tool;
  if (!hits_.empty()) add_strokes(m, hold);
  return hold;
}

void ProgramHolds::add_strokes(const Motion& m, MotionHold& hold) {
  const PunchTimes& times = options_.turret->times;
  if (punch_->nibbles(m)) {
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

double ProgramHolds::stroke_s(double pitch_mm, double move_s) const {
  const PunchTimes& times = options_.turret->times;
  const double period_s = pitch_mm > 0 ? times.period_s(pitch_mm) : 0;
  return std::max(times.stroke_s, period_s - move_s);
}

/// The machine holds its motion from M3 on, and a dwell that follows goes on meanwhile.
MotionHold ProgramHolds::of_torch(const Motion& m) {
  MotionHold hold;
  const bool lit = m.start_known && options_.torch->on(m);
  if (!lit) {
    // Held off by its output the torch has no pause: that is M5's.
    const bool stopped = (m.torch.spindles_on & 1) == 0;
    if (std::exchange(pierced_, false) && stopped) hold.before.pauses_s = pause_s_;
    dwelt_s_ = 0;
    return hold;
  }
  if (pierced_) return hold;
  if (m.kind == MotionKind::kDwell) dwelt_s_ += m.duration_s;
  if (m.kind != MotionKind::kTraverse && !is_feed(m)) return hold;
  pierced_ = true;
  pause_s_ = 0;
  if (m.torch.material >= materials_.size()) return hold;
  const TorchMaterial& material = materials_[m.torch.material];
  hold.before.pierces_s = std::max(0.0, material.pierce_delay_s - dwelt_s_);
  pause_s_ = std::max(0.0, material.pause_at_end_s);
  return hold;
}

std::string ProgramHolds::text() const {
  if (options_.torch) {
    return "; pierce delays and pauses at the ends of cuts by the materials, probing and the start "
           "of the arc no time";
  }
  if (!options_.turret) return {};
  const PunchTimes& times = options_.turret->times;
  if (!times.any()) {
    return fmt::format("; strokes, turret and re-gripping no time ({} has no times)",
                       options_.turret->path);
  }
  std::string out = fmt::format("; a stroke {:g} s", times.stroke_s);
  if (!times.period_by_pitch_s.empty()) {
    const auto& [pitch_mm, period_s] = *times.period_by_pitch_s.begin();
    out += fmt::format(", nibbling at most {:g} a minute at {:g} mm", 60 / period_s, pitch_mm);
  }
  return out + fmt::format(", the turret {:g} s a change and {:g} s a place, re-gripping {:g} s",
                           times.lock_s, times.step_s, times.regrip_s);
}

}  // namespace kerf
