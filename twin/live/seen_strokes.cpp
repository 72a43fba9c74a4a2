#include "twin/live/seen_strokes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

using Kind = BeamTrigger::Kind;

/// A spindle slower than this stands. rpm.
constexpr double kStanding_rpm = 1.0;
/// Sensors tremble: a sheet that has moved less stands. mm.
constexpr double kStill_mm = 0.005;
/// Hits at the ends of moves lie farther apart: a machine that brakes creeps through the last of
/// its way in steps that are less than kStill_mm.
constexpr double kApart_mm = 0.05;
/// Z that comes down by less is no stroke, and up by as much it is over. mm.
constexpr double kPlunge_mm = 0.5;
constexpr double kBack_mm = 0.05;

Vec2 flat(const ProgramPose& place) { return Vec2(place.tip_mm); }

bool by_spindle(const BeamTrigger::Term& term) {
  return (term.kind == Kind::kSpindle && term.index <= 0) || term.kind == Kind::kCounterclockwise ||
         term.kind == Kind::kSpeed;
}

}  // namespace

std::optional<bool> SeenStrokes::is_on(const AxisSample& sample, const Vec3& place_mm) const {
  if (sample.trigger != AxisSample::kUnknown) return sample.trigger != 0;
  if (turret_->trigger.kind() != PunchTrigger::Kind::kState) return std::nullopt;
  for (const BeamTrigger::Term& term : turret_->trigger.state().terms()) {
    const bool told =
        by_spindle(term) ? !std::isnan(sample.spindle_rpm) : term.kind == Kind::kBelow;
    if (!told) return std::nullopt;
  }
  Motion standing;
  standing.from_mm = standing.to_mm = place_mm;
  if (std::abs(sample.spindle_rpm) >= kStanding_rpm) {
    const bool clockwise = sample.spindle_rpm > 0;
    standing.spindle = clockwise ? SpindleState::kClockwise : SpindleState::kCounterclockwise;
    standing.spindle_rpm = std::abs(sample.spindle_rpm);
    standing.torch.spindles_on = 1;
  }
  return turret_->trigger.state().on(standing);
}

std::string SeenStrokes::missing() const {
  if (turret_->trigger.kind() == PunchTrigger::Kind::kState) {
    const auto& terms = turret_->trigger.state().terms();
    const bool spindle = std::all_of(terms.begin(), terms.end(), [](const BeamTrigger::Term& term) {
      return by_spindle(term) || term.kind == Kind::kBelow;
    });
    if (spindle) return tr("neither a spindle speed nor a trigger");
  }
  return tr("no trigger");
}

std::span<const PunchHit> SeenStrokes::take(const AxisSample& sample, const ProgramPose& place,
                                            int tool, bool gap) {
  hits_.clear();
  drags_ = false;
  if (gap) {
    before_.reset();
    on_.reset();
    bottom_.reset();
  }
  const bool plunges = turret_->trigger.kind() == PunchTrigger::Kind::kPlunge &&
                       sample.trigger == AxisSample::kUnknown;
  const std::optional<bool> on = plunges ? std::nullopt : is_on(sample, place.tip_mm);
  told_ = plunges || on.has_value();
  if (plunges) {
    take_plunge(place, tool);
  } else if (on) {
    take_state(*on, place, tool);
  }
  on_ = on;
  // A slow machine adds up what a sample alone does not show.
  if (!before_ || plunges || glm::length(flat(place) - flat(*before_)) >= kStill_mm) {
    before_ = place;
  }
  return hits_;
}

void SeenStrokes::take_state(bool on, const ProgramPose& place, int tool) {
  if (!before_ || !on_) return;
  const double way_mm = glm::length(flat(place) - flat(*before_));
  const double pitch_mm = turret_->nibbles ? 0 : turret_->pitch_mm(tool);
  if (on && !*on_) {
    since_mm_ = 0;
    if (!turret_->strikes_at_ends) strike(place, tool);
  } else if (on && turret_->strikes_at_ends) {
    since_mm_ += way_mm;
    if (way_mm < kStill_mm && since_mm_ >= kApart_mm) strike(place, tool);
  } else if (on && pitch_mm > 0) {
    if (way_mm >= kStill_mm) nibble(place, tool, pitch_mm);
  } else if (on) {
    drags_ = way_mm >= kStill_mm;
  } else if (*on_ && since_mm_ >= (turret_->strikes_at_ends ? kApart_mm : kStill_mm) &&
             (turret_->strikes_at_ends || pitch_mm > 0)) {
    strike(*before_, tool);
  }
}

/// The rest of the way stays for the next sample, or for where the trigger goes off.
void SeenStrokes::nibble(const ProgramPose& place, int tool, double pitch_mm) {
  const ProgramPose from = *before_;
  const double way_mm = glm::length(flat(place) - flat(from));
  double at_mm = pitch_mm - since_mm_;
  since_mm_ += way_mm;
  for (; at_mm <= way_mm; at_mm += pitch_mm) {
    ProgramPose between = place;
    between.tip_mm = from.tip_mm + (at_mm / way_mm) * (place.tip_mm - from.tip_mm);
    strike(between, tool);
    since_mm_ = way_mm - at_mm;
  }
}

void SeenStrokes::take_plunge(const ProgramPose& place, int tool) {
  if (!before_) {
    top_mm_ = place.tip_mm.z;
    return;
  }
  const bool sideways = glm::length(flat(place) - flat(*before_)) >= kStill_mm;
  const double z = place.tip_mm.z;
  if (bottom_ && (sideways || z > bottom_->tip_mm.z + kBack_mm)) {
    if (top_mm_ - bottom_->tip_mm.z >= kPlunge_mm) strike(*bottom_, tool);
    bottom_.reset();
    top_mm_ = z;
  } else if (sideways || z > top_mm_) {
    top_mm_ = z;
  } else if (!bottom_ ? z < top_mm_ : z < bottom_->tip_mm.z) {
    bottom_ = place;
  }
}

void SeenStrokes::strike(const ProgramPose& place, int tool) {
  Motion standing;
  standing.tool = tool;
  standing.from_mm = standing.to_mm = place.tip_mm;
  standing.from_abc_deg = standing.to_abc_deg = place.abc_deg;
  hits_.push_back({place.tip_mm, moves_.turn_rad(standing, 1), 1});
  since_mm_ = 0;
}

}  // namespace kerf
