#include "stock/turning/turn_move.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "stock/turning/thread_pass.h"

namespace kerf {

bool TurnMove::winds() const {
  return !arc && std::isfinite(lead_mm) && std::abs(lead_mm) >= turning::kLeastLead_mm;
}

namespace turning {
namespace {

bool is_finite(const Vec2& v) { return std::isfinite(v.x) && std::isfinite(v.y); }

/// The part of a chord within |z|, |x| <= reach.
bool clip(WayChord& chord, double reach) {
  for (int axis = 0; axis < 2; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const double from = sign * chord.from.at_mm[axis] - reach;
      const double to = sign * chord.to.at_mm[axis] - reach;
      if (from > 0 && to > 0) return false;
      if (from <= 0 && to <= 0) continue;
      const double share = from / (from - to);
      WayPoint at;
      at.at_mm = chord.from.at_mm + share * (chord.to.at_mm - chord.from.at_mm);
      at.at_mm[axis] = sign * reach;
      at.t = chord.from.t + share * (chord.to.t - chord.from.t);
      (from > 0 ? chord.from : chord.to) = at;
    }
  }
  return true;
}

}  // namespace

std::optional<ArcSteps> way_steps(double radius_mm, double sweep_rad) {
  const double sweep = std::abs(sweep_rad);
  if (!std::isfinite(radius_mm) || !std::isfinite(sweep)) return std::nullopt;
  // Before they are counted: a whole number may not hold how many there would be.
  if (sweep * std::max(1.0, std::sqrt(radius_mm / (12 * kWayBound_mm))) > kMostSteps)
    return std::nullopt;
  return arc_steps(radius_mm, sweep, kWayBound_mm);
}

void append_way(const TurnMove& move, double reach_mm, std::vector<WayChord>& chords) {
  if (!is_finite(move.from_mm) || !is_finite(move.to_mm)) return;
  const auto append = [&](const WayPoint& from, const WayPoint& to) {
    WayChord chord{from, to};
    if (clip(chord, reach_mm)) chords.push_back(chord);
  };
  WayPoint at{move.from_mm, 0};
  if (move.arc) {
    const Vec2 from = move.from_mm - move.arc->center_mm, to = move.to_mm - move.arc->center_mm;
    const double r0 = glm::length(from), r1 = glm::length(to), sweep = move.arc->sweep_rad;
    const std::optional<ArcSteps> steps = way_steps(std::max(r0, r1), sweep);
    if (!steps) return;
    const double start = portable::atan2(from.y, from.x);
    for (int i = 0; i < steps->count; ++i) {
      const double t = (i + 0.5) / steps->count;
      const double angle = start + t * sweep, r = (r0 + t * (r1 - r0)) * steps->outward;
      const WayPoint next{
          move.arc->center_mm + r * Vec2(portable::cos(angle), portable::sin(angle)), t};
      append(at, next);
      at = next;
    }
  }
  append(at, {move.to_mm, 1});
}

}  // namespace turning
}  // namespace kerf
