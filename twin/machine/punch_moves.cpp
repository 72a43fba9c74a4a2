#include "twin/machine/punch_moves.h"

#include <cmath>

#include "base/units.h"
#include "stock/sheet/punch_hits.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// A rest of a row that is shorter is none: the end has its stroke.
constexpr double kSamePlace_mm = 1e-6;

using Kind = PunchTrigger::Kind;

/// Where M62 counts from is a moment, and its motion's own: Z is looked at apart.
bool holds_at(const BeamTrigger& trigger, const Motion& motion, const Vec3& place_mm) {
  Motion standing = motion;
  standing.from_mm = standing.to_mm = place_mm;
  return trigger.on(standing);
}

}  // namespace

bool ClampPlace::follow(const Motion& m) {
  bool moved = false;
  for (std::size_t i = 0; i < turret_->regrips.size(); ++i) {
    const Regrip& regrip = turret_->regrips[i];
    const bool by_code =
        regrip.user_code != 0 && m.kind == MotionKind::kSignal && m.user_m == regrip.user_code;
    const bool by_line =
        regrip.line != 0 && !line_done_[i] && m.source.file == 0 && m.source.line == regrip.line;
    if (!by_code && !by_line) continue;
    line_done_[i] = line_done_[i] || by_line;
    shift_mm_ += regrip.shift_mm;
    moved = true;
  }
  return moved;
}

bool PunchMoves::holds(const Motion& m, double share) const {
  if (!m.start_known || m.kind == MotionKind::kProgramEnd) return false;
  if (turret_->trigger.kind() == Kind::kState) {
    return is_on_at(m, share <= 0 ? m.from_mm : share >= 1 ? m.to_mm : point_at(m, share));
  }
  return (share >= 1 || m.kind == MotionKind::kSignal) && strikes_at_end(m);
}

bool PunchMoves::is_on_at(const Motion& m, const Vec3& place) const {
  return turret_->trigger.kind() == Kind::kState && holds_at(turret_->trigger.state(), m, place);
}

bool PunchMoves::nibbles(const Motion& m) const {
  return m.start_known && moves_sideways(m) && nibbles_from(m);
}

/// On a feed, wherever it begins.
bool PunchMoves::nibbles_from(const Motion& m) const {
  if (turret_->pitch_mm(m.tool) <= 0 || !is_feed(m)) return false;
  // The reader of turrets sees to it that one of them is there.
  const BeamTrigger& state = turret_->nibbles ? *turret_->nibbles : turret_->trigger.state();
  return holds_at(state, m, m.from_mm) && holds_at(state, m, m.to_mm);
}

bool PunchMoves::drags(const Motion& m) const {
  return m.start_known && !turret_->strikes_at_ends && !nibbles(m) && moves_sideways(m) &&
         is_on_at(m, m.from_mm) && is_on_at(m, m.to_mm);
}

bool PunchMoves::strikes_at_end(const Motion& m) const {
  if (!m.start_known) return false;
  switch (turret_->trigger.kind()) {
    case Kind::kUserCode:
      return m.kind == MotionKind::kSignal && m.user_m == turret_->trigger.user_code();
    case Kind::kPlunge:
      return is_feed(m) && !moves_sideways(m) && m.to_mm.z < m.from_mm.z;
    case Kind::kState:
      break;
  }
  if (!is_on_at(m, m.to_mm)) return false;
  if (turret_->strikes_at_ends) return moves_sideways(m);
  return !is_on_at(m, m.from_mm);
}

namespace {

bool ends_at_known_place(const Motion& m) {
  constexpr unsigned kXy = 3;
  return (m.unknown_to & kXy) == 0;
}

}  // namespace

/// Whether it comes from afar or stands there already, a stroke comes at its end.
bool PunchMoves::strikes_at_known_end(const Motion& m) const {
  const bool goes = is_feed(m) || is_traverse(m);
  if (m.start_known || !goes || !ends_at_known_place(m)) return false;
  if (turret_->strikes_at_ends && is_on_at(m, m.to_mm)) return true;
  return nibbles_from(m);
}

bool PunchMoves::strikes_unseen(const Motion& m) const {
  if (m.start_known || m.kind == MotionKind::kProgramEnd) return false;
  const bool goes = is_feed(m) || is_traverse(m);
  switch (turret_->trigger.kind()) {
    case Kind::kUserCode:
      return (m.kind == MotionKind::kSignal && m.user_m == turret_->trigger.user_code()) ||
             nibbles_from(m);
    case Kind::kPlunge:
      return is_feed(m);
    case Kind::kState:
      break;
  }
  // What nibbles strikes along its way, too.
  if (nibbles_from(m)) return true;
  if (!is_on_at(m, m.to_mm)) return false;
  return turret_->strikes_at_ends ? goes && !ends_at_known_place(m) : true;
}

double PunchMoves::turn_rad(const Motion& m, double share) const {
  const TurretStation* const station = turret_->station(m.tool);
  if (station == nullptr) return 0;
  double angle_deg = station->angle_deg;
  if (station->turns && turret_->index.analog) {
    angle_deg += double{m.torch.analog[static_cast<std::size_t>(*turret_->index.analog)]};
  } else if (station->turns) {
    const auto axis = static_cast<std::size_t>(turret_->index.axis);
    const double from = m.from_abc_deg[axis], to = m.to_abc_deg[axis];
    angle_deg += share >= 1 ? to : from + share * (to - from);
  }
  return angle_deg * kRadPerDeg;
}

PunchHit PunchMoves::hit_at(const Motion& m, double share) const {
  const Vec3 place = share <= 0 ? m.from_mm : share >= 1 ? m.to_mm : point_at(m, share);
  return {place, turn_rad(m, share), share};
}

void PunchMoves::append_row(const Motion& m, std::vector<PunchHit>& out) const {
  const double length = path_length_mm(m);
  const double pitch = std::max(turret_->pitch_mm(m.tool), length / kMostHits);
  for (int n = 1; n * pitch < length - kSamePlace_mm; ++n) {
    out.push_back(hit_at(m, n * pitch / length));
  }
  out.push_back(hit_at(m, 1));
}

CutMove PunchMoves::stroke_of(const PunchHit& hit, std::uint64_t id) {
  return punch_stroke(hit.place_mm, hit.turn_rad, id);
}

}  // namespace kerf
