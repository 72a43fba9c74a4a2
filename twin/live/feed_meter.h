// twin/live/feed_meter.h - how fast a machine really goes, from where it has been.
#pragma once

#include <deque>
#include <optional>

#include "base/geometry.h"

namespace kerf {

/// The way of a point over the last fifth of a second, by the time that it took. Long enough that
/// the steps of a scale or of a clock do not show, short enough that a hand at the feed override
/// sees what it does. O(1) a place.
class FeedMeter {
 public:
  static constexpr double kWindow_s = 0.2;
  /// Of places that are nearer in time the last one counts: a scale that trembles by a thousandth
  /// a thousand times a second goes nowhere, and is no feed of 60 mm/min.
  static constexpr double kApart_s = 0.02;
  /// After longer without a place nobody knows what was between.
  static constexpr double kLongestGap_s = 2.0;

  /// Of one clock. A time that goes back begins anew.
  void take(double t_s, const Vec3& at_mm);
  /// The next place is not reached from the last one.
  void forget() { places_.clear(); }
  /// None: too little is known yet, a quarter of kWindow_s.
  std::optional<double> mm_per_min() const;

 private:
  struct Place {
    double t_s;
    Vec3 at_mm;
  };
  std::deque<Place> places_;
};

}  // namespace kerf
