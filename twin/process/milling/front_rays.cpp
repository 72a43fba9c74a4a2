#include "twin/process/milling/front_rays.h"

#include <algorithm>
#include <cmath>

namespace kerf {

const std::array<double, FrontRays::kSteps + 1>& FrontRays::step_sines() {
  static const std::array<double, kSteps + 1> sines = [] {
    std::array<double, kSteps + 1> made{};
    for (std::size_t k = 0; k <= kSteps; ++k) made[k] = std::sin(step_rad(k));
    return made;
  }();
  return sines;
}

const std::array<FrontWay, FrontRays::kSteps + 1>& FrontRays::step_ways() {
  static const std::array<FrontWay, kSteps + 1> ways = [] {
    std::array<FrontWay, kSteps + 1> made{};
    for (std::size_t k = 0; k <= kSteps; ++k)
      made[k] = FrontWay::of(std::clamp(step_rad(k), kRim_rad - kPi / 2, kPi / 2 - kRim_rad));
    return made;
  }();
  return ways;
}

/// A height that changes evenly: by Simpson's rule, which is right of its products.
void FrontRays::add(const Direction& from, const Direction& to) {
  span(from, to);
  const double width = to.angle - from.angle;
  const Direction middle{0.5 * (from.angle + to.angle), 0.5 * (from.high_mm + to.high_mm)};
  const auto sum = [&](auto&& value) {
    return width / 6 * (value(from) + 4 * value(middle) + value(to));
  };
  heights_.plain += width * middle.high_mm;
  if (to.angle <= 0) heights_.right += width * middle.high_mm;
  heights_.angle += sum([](const Direction& at) { return at.high_mm * at.angle; });
  heights_.angle2 += sum([](const Direction& at) { return at.high_mm * at.angle * at.angle; });
  heights_.square += sum([](const Direction& at) { return at.high_mm * at.high_mm; });
}

/// Most lie over the one before.
void FrontRays::add_span(const Span& span) {
  if (spans_.empty() || span.right_mm > spans_.back().left_mm ||
      spans_.back().right_mm > span.left_mm)
    return spans_.push_back(span);
  Span& last = spans_.back();
  last = {std::min(last.right_mm, span.right_mm), std::max(last.left_mm, span.left_mm)};
}

double FrontRays::gaps_mm() {
  std::sort(spans_.begin(), spans_.end(),
            [](const Span& a, const Span& b) { return a.right_mm < b.right_mm; });
  double gaps_mm = 0, until_mm = std::numeric_limits<double>::infinity();
  for (const Span& span : spans_) {
    gaps_mm += std::max(0.0, span.right_mm - until_mm - apart_mm_);
    until_mm = std::isinf(until_mm) ? span.left_mm : std::max(until_mm, span.left_mm);
  }
  return gaps_mm;
}

void FrontRays::settle() {
  found_.gaps_mm = gaps_mm();
  if (heights_.plain <= 0) return;
  const double middle = heights_.angle / heights_.plain;
  const double half =
      std::sqrt(std::max(0.0, 3 * (heights_.angle2 / heights_.plain - middle * middle)));
  right_rad_ = std::max(middle - half, -kPi / 2);
  left_rad_ = std::min(middle + half, kPi / 2);
  found_.angle_rad =
      std::min(heights_.plain * heights_.plain / heights_.square, left_rad_ - right_rad_);
  right_of_way_rad_ = found_.angle_rad * heights_.right / heights_.plain;
}

EngagementLook FrontRays::look(bool anticlockwise) const {
  EngagementLook look = found_;
  if (look.angle_rad <= 0) return {};
  // Up to the rim itself, where the outermost directions are in it.
  const double rim = std::sin(kPi / 2 - kRim_rad);
  const double low_mm = low_mm_ < 0 ? std::max(low_mm_ / rim, -radius_mm_) : low_mm_;
  const double high_mm = high_mm_ > 0 ? std::min(high_mm_ / rim, radius_mm_) : high_mm_;
  look.gaps_mm = std::clamp(look.gaps_mm, 0.0, high_mm - low_mm);
  look.wide_mm = high_mm - low_mm - look.gaps_mm;
  const double right_share = right_of_way_rad_ / look.angle_rad;
  look.entry_rad = kPi / 2 + (anticlockwise ? right_rad_ : -left_rad_);
  look.exit_rad = kPi / 2 + (anticlockwise ? left_rad_ : -right_rad_);
  look.climb = anticlockwise ? 1 - right_share : right_share;
  return look;
}

}  // namespace kerf
