#include "twin/process/milling/front_rays.h"

namespace kerf {

EngagementLook FrontRays::look(bool anticlockwise) const {
  EngagementLook look = found_;
  if (look.angle_rad <= 0) return {};
  // Up to the rim itself, where the outermost directions are in it.
  const double rim = std::sin(kPi / 2 - kRim_rad);
  const double low_mm = low_mm_ < 0 ? std::max(low_mm_ / rim, -radius_mm_) : low_mm_;
  const double high_mm = high_mm_ > 0 ? std::min(high_mm_ / rim, radius_mm_) : high_mm_;
  look.wide_mm = high_mm - low_mm;
  const double right_share = right_of_way_rad_ / look.angle_rad;
  look.entry_rad = kPi / 2 + (anticlockwise ? right_rad_ : -left_rad_);
  look.exit_rad = kPi / 2 + (anticlockwise ? left_rad_ : -right_rad_);
  look.climb = anticlockwise ? 1 - right_share : right_share;
  return look;
}

}  // namespace kerf
