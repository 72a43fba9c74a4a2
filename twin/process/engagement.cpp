#include "twin/process/engagement.h"

namespace kerf {

void EngagementSums::add(const EngagementLook& look, const EngagedWay& way) {
  const double length_mm = way.length_mm;
  cut_s += way.seconds;
  effective_most_mm = std::max(effective_most_mm, look.effective_mm);
  if (look.is_plunge) {
    plunge_mm += length_mm;
    return;
  }
  cut_mm += length_mm;
  if (look.angle_rad >= kFullSlot_rad) full_mm += length_mm;
  if (look.cuts_centre && way.down_rad >= kLeastRamp_rad) {
    ramp_mm += length_mm;
    ramp_most_rad = std::max(ramp_most_rad, way.down_rad);
  }
  wide_sum_mm2 += look.wide_mm * length_mm;
  angle_sum += look.angle_rad * length_mm;
  deep_sum_mm2 += look.deep_mm * length_mm;
  climb_mm += look.climb * length_mm;
  entry_sum += look.entry_rad * length_mm;
  exit_sum += look.exit_rad * length_mm;
  wide_most_mm = std::max(wide_most_mm, look.wide_mm);
  angle_most_rad = std::max(angle_most_rad, look.angle_rad);
  deep_most_mm = std::max(deep_most_mm, look.deep_mm);
  contact_most_mm = std::max(contact_most_mm, look.contact_mm);
}

void EngagementSums::take_back(const EngagementLook& look, const EngagedWay& way) {
  EngagementSums back;
  back.add(look, way);
  const auto less = [](double& sum, double by) { sum = std::max(0.0, sum - by); };
  less(cut_s, back.cut_s), less(cut_mm, back.cut_mm), less(plunge_mm, back.plunge_mm);
  less(full_mm, back.full_mm), less(ramp_mm, back.ramp_mm), less(climb_mm, back.climb_mm);
  less(wide_sum_mm2, back.wide_sum_mm2), less(angle_sum, back.angle_sum);
  less(deep_sum_mm2, back.deep_sum_mm2);
  less(entry_sum, back.entry_sum), less(exit_sum, back.exit_sum);
}

void EngagementSums::add(const EngagementSums& other) {
  cut_mm += other.cut_mm, plunge_mm += other.plunge_mm, full_mm += other.full_mm;
  cut_s += other.cut_s, ramp_mm += other.ramp_mm, climb_mm += other.climb_mm;
  ramp_most_rad = std::max(ramp_most_rad, other.ramp_most_rad);
  wide_sum_mm2 += other.wide_sum_mm2;
  angle_sum += other.angle_sum;
  deep_sum_mm2 += other.deep_sum_mm2;
  entry_sum += other.entry_sum, exit_sum += other.exit_sum;
  wide_most_mm = std::max(wide_most_mm, other.wide_most_mm);
  angle_most_rad = std::max(angle_most_rad, other.angle_most_rad);
  deep_most_mm = std::max(deep_most_mm, other.deep_most_mm);
  contact_most_mm = std::max(contact_most_mm, other.contact_most_mm);
  effective_most_mm = std::max(effective_most_mm, other.effective_most_mm);
  removed_mm3 += other.removed_mm3;
  rate_most_mm3_per_s = std::max(rate_most_mm3_per_s, other.rate_most_mm3_per_s);
}

void TurningEngagement::add(const TurnedWay& way) {
  const double in_s = way.length_mm > 0 ? way.seconds * way.cut_mm / way.length_mm : 0;
  feed_mm += way.length_mm, feed_s += way.seconds;
  air_mm += way.length_mm - way.cut_mm, air_s += way.seconds - in_s;
  if (way.cut_mm <= 0) return;
  cut_mm += way.cut_mm, cut_s += in_s, removed_mm3 += way.removed_mm3;
  depth_sum_mm2 += way.depth_mm * way.cut_mm;
  feed_sum += way.feed_mm_per_rev * way.cut_mm;
  chip_sum += way.chip_mm * way.cut_mm;
  depth_most_mm = std::max(depth_most_mm, way.depth_mm);
  feed_most_mm = std::max(feed_most_mm, way.feed_mm_per_rev);
  chip_most_mm = std::max(chip_most_mm, way.chip_mm);
  if (in_s > 0) rate_most_mm3_per_s = std::max(rate_most_mm3_per_s, way.removed_mm3 / in_s);
}

}  // namespace kerf
