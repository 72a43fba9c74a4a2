#include "twin/process/milling/way_profile.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

Motion motion_of(const CutMove& move) {
  Motion motion;
  motion.kind = move.arc ? MotionKind::kArc : MotionKind::kFeed;
  motion.from_mm = move.from_mm;
  motion.to_mm = move.to_mm;
  if (move.arc) motion.arc = {move.arc->center_mm, move.arc->axis, move.arc->sweep_rad};
  return motion;
}

}  // namespace

WayProfile::WayProfile(double length_mm, double duration_s, double speed_mm_per_s) {
  if (length_mm <= 0 || duration_s <= 0) return;
  length_mm_ = length_mm;
  duration_s_ = duration_s;
  // A motion that is blended with the next one may have less time than its way takes.
  speed_mm_per_s_ = speed_mm_per_s > 0 ? speed_mm_per_s : length_mm / duration_s;
  ramp_s_ = std::max(0.0, duration_s - length_mm / speed_mm_per_s_);
  ramp_mm_ = speed_mm_per_s_ * ramp_s_ / 2;
  if (ramp_mm_ * 2 > length_mm) ramp_mm_ = ramp_s_ = 0;
}

/// Up to full speed within ramp_mm_, and down again.
double WayProfile::at_s(double part) const {
  const double way = part * length_mm_;
  if (ramp_mm_ <= 0) return part * duration_s_;
  const double acceleration = speed_mm_per_s_ / ramp_s_;
  if (way < ramp_mm_) return std::sqrt(2 * way / acceleration);
  const double left = length_mm_ - way;
  if (left < ramp_mm_) return duration_s_ - std::sqrt(std::max(0.0, 2 * left / acceleration));
  return ramp_s_ + (way - ramp_mm_) / speed_mm_per_s_;
}

double WayProfile::speed_at(double part) const {
  const double way = std::min(part, 1 - part) * length_mm_;
  if (way >= ramp_mm_) return speed_mm_per_s_;
  return std::sqrt(2 * std::max(0.0, way) * speed_mm_per_s_ / ramp_s_);
}

double WayProfile::greatest_speed(double from, double to) const {
  return speed_at(std::clamp(0.5, from, to));
}

double way_length_mm(const CutMove& move) {
  return move.arc ? path_length_mm(motion_of(move)) : glm::length(move.to_mm - move.from_mm);
}

CutMove part_of(const CutMove& whole, double from, double to) {
  const Motion motion = motion_of(whole);
  CutMove part = whole;
  if (from > 0) part.from_mm = point_at(motion, from);
  if (to < 1) part.to_mm = point_at(motion, to);
  if (part.arc) part.arc->sweep_rad *= to - from;
  return part;
}

}  // namespace kerf
