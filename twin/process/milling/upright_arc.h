// twin/process/milling/upright_arc.h - an arc in a plane that stands upright (G18, G19), as an
// upright tool drives it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "base/geometry.h"
#include "base/golden_section.h"
#include "stock/stock_model.h"

namespace kerf {

///            z ^   .-'''-.          An angle is one from `across`, level and square to the axis,
///              | .'       '.        towards z. A way along the axis goes evenly with it.
///              |/  center   \       .
///              +-----*-------> across
///
class UprightArc {
 public:
  /// Null: no arc, or about another axis than a level one, or its ends lie more than kRounded_mm
  /// (way_profile.h) less or more far from its centre, or the tool is tilted.
  static std::optional<UprightArc> of(const CutMove& move);

  double sweep_rad() const { return std::abs(sweep_); }
  double radius_mm() const { return std::min(r0_, r1_); }
  /// Of its way, where it stops going one way, seen from above, and comes back: in order.
  std::vector<double> turning_parts() const;
  /// Not under its centre: so it has been as low before as it is, on its other side.
  bool is_hill(double from, double to) const;
  /// The straight way that touches it there, upright tool and all; it ends where the arc does at
  /// `until`, seen along the way, and begins at `at`. Of a way straight up or down hardly so.
  CutMove line_at(double at, double until) const;
  Vec3 point_at(double part) const;

  /// How low a tool comes over the point on a part of the way; infinite: it does not.
  /// `lift(mm)`: of its surface over its tip, so far from its middle, up to `radius_mm`. To
  /// 0.0001 mm of tools with no edge but their rim. A way that also climbs along the axis may be
  /// missed where it is over the point for less than an eighth of how long one in a plane would be.
  template <class Lift>
  double lowest_over(const Vec2& point, double from, double to, double radius_mm,
                     const Lift& lift) const;

 private:
  double angle_at(double part) const { return start_ + part * sweep_; }
  double part_of(double angle) const { return (angle - start_) / sweep_; }

  static constexpr int kPlaces = 8, kNarrowings = 14, kHalvings = 16;
  static constexpr double kPlane_mm = 1e-6;  ///< a way that climbs no more lies in a plane
  CutMove move_;
  Vec3 across_{1, 0, 0}, axis_{0, 1, 0};
  double center_along_ = 0;  ///< of the first point, from the centre, along the axis
  double climb_mm_ = 0;      ///< along the axis, over all of the way
  double r0_ = 0, r1_ = 0, start_ = 0, sweep_ = 0;
};

template <class Lift>
double UprightArc::lowest_over(const Vec2& point, double from, double to, double radius_mm,
                               const Lift& lift) const {
  double lowest = std::numeric_limits<double>::infinity();
  if (to <= from) return lowest;
  const auto over = [&](double part) {
    const Vec3 tip = point_at(part);
    const double x = point.x - tip.x, y = point.y - tip.y;
    const double distance = std::sqrt(x * x + y * y);
    return distance > radius_mm ? std::numeric_limits<double>::infinity() : tip.z + lift(distance);
  };
  const double r = std::max(0.5 * (r0_ + r1_), 1e-9), slack = std::abs(r1_ - r0_);
  const Vec2 arm = point - Vec2(move_.arc->center_mm);
  const double across = arm.x * across_.x + arm.y * across_.y;
  const double aside = arm.x * axis_.x + arm.y * axis_.y - center_along_;
  const bool is_plane = std::abs(climb_mm_) < kPlane_mm;
  if (is_plane && std::abs(aside) > radius_mm + kPlane_mm) return lowest;
  const double half =
      is_plane ? std::sqrt(std::max(0.0, radius_mm * radius_mm - aside * aside)) + kPlane_mm
               : radius_mm;
  const double left = (across - half - slack) / r, right = (across + half + slack) / r;
  if (left > 1 || right < -1) return lowest;
  const double near = std::acos(std::clamp(right, -1.0, 1.0));
  const double far = std::acos(std::clamp(left, -1.0, 1.0));
  const double first = std::min(angle_at(from), angle_at(to));
  const double last = std::max(angle_at(from), angle_at(to));
  const auto look_between = [&](double low, double high) {
    low = std::max(low, first), high = std::min(high, last);
    if (low >= high) return;
    double best = low, least = std::numeric_limits<double>::infinity();
    const double step = (high - low) / kPlaces;
    const auto at_angle = [&](double angle) { return over(part_of(angle)); };
    bool was_over = false;
    for (int k = 0; k <= kPlaces; ++k) {
      const double angle = low + k * step, found = at_angle(angle);
      if (found < least) least = found, best = angle;
      const bool is_over = found < std::numeric_limits<double>::infinity();
      // With its rim a flat tool is there first, and last.
      if (k > 0 && is_over != was_over) {
        double in = is_over ? angle : angle - step, out = is_over ? angle - step : angle;
        for (int n = 0; n < kHalvings; ++n) {
          const double middle = 0.5 * (in + out);
          (at_angle(middle) < std::numeric_limits<double>::infinity() ? in : out) = middle;
        }
        lowest = std::min(lowest, at_angle(in));
      }
      was_over = is_over;
    }
    const double narrow_low = std::max(low, best - step), narrow_high = std::min(high, best + step);
    least = std::min(least, golden_section(at_angle, narrow_low, narrow_high, kNarrowings).least);
    lowest = std::min(lowest, least);
  };
  const double turns = std::floor((first + kPi) / (2 * kPi));
  for (double turn = turns * 2 * kPi; turn - kPi < last; turn += 2 * kPi) {
    // Where both sides meet, over the centre or under it, they are one.
    if (near <= 0) {
      look_between(turn - far, turn + far);
    } else {
      look_between(turn + near, turn + far);
      look_between(turn - far, turn - near);
    }
  }
  return lowest;
}

}  // namespace kerf
