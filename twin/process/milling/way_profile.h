// twin/process/milling/way_profile.h - when a machine is where along a move.
#pragma once

#include <algorithm>

#include "stock/stock_model.h"

namespace kerf {

/// Time and speed at a fraction of a move's way. As if the machine started and ended at rest, with
/// equal ramps, where the move takes longer than its way does at its greatest speed; else at one
/// speed. 0 long: nothing is known.
class WayProfile {
 public:
  WayProfile() = default;
  /// `speed_mm_per_s`: the greatest on the way, 0: not known. Nothing is known of a way of no
  /// length or no time.
  WayProfile(double length_mm, double duration_s, double speed_mm_per_s) {
    if (length_mm <= 0 || duration_s <= 0) return;
    length_mm_ = length_mm;
    duration_s_ = duration_s;
    // A motion that is blended with the next one may have less time than its way takes.
    speed_mm_per_s_ = speed_mm_per_s > 0 ? speed_mm_per_s : length_mm / duration_s;
    ramp_s_ = std::max(0.0, duration_s - length_mm / speed_mm_per_s_);
    ramp_mm_ = speed_mm_per_s_ * ramp_s_ / 2;
    if (ramp_mm_ * 2 > length_mm) ramp_mm_ = ramp_s_ = 0;
  }

  double length_mm() const { return length_mm_; }
  double speed_mm_per_s() const { return speed_mm_per_s_; }
  /// Seconds from the move's begin to this fraction.
  double at_s(double part) const;
  double speed_at(double part) const;
  double greatest_speed(double from, double to) const;

 private:
  double length_mm_ = 0, duration_s_ = 0, speed_mm_per_s_ = 0;
  double ramp_mm_ = 0, ramp_s_ = 0;
};

double way_length_mm(const CutMove& move);
/// Of its way, from one fraction to another.
CutMove part_of(const CutMove& whole, double from, double to);

/// Of an arc about Z whose ends lie up to kRounded_mm more or less far from its centre, as the
/// digits of I and J leave it: a circle with the same sweep, half of that off at most, and a tenth
/// on half a turn and less. Other moves as they are.
CutMove as_circle(const CutMove& move);
constexpr double kRounded_mm = 0.05;

}  // namespace kerf
