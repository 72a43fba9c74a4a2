#include "twin/process/milling/way_profile.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr double kSameRadius_mm = 1e-6;
/// A circle through both ends of an arc that nearly closes would lie far from it in between.
constexpr double kMostThroughEnds_rad = 1.5 * kPi;

Motion motion_of(const CutMove& move) {
  Motion motion;
  motion.kind = move.arc ? MotionKind::kArc : MotionKind::kFeed;
  motion.from_mm = move.from_mm;
  motion.to_mm = move.to_mm;
  if (move.arc) motion.arc = {move.arc->center_mm, move.arc->axis, move.arc->sweep_rad};
  return motion;
}

}  // namespace

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
  if (from == 0 && to == 1) return whole;
  const Motion motion = motion_of(whole);
  CutMove part = whole;
  if (from > 0) part.from_mm = point_at(motion, from);
  if (to < 1) part.to_mm = point_at(motion, to);
  if (part.arc) part.arc->sweep_rad *= to - from;
  return part;
}

CutMove as_circle(const CutMove& move) {
  if (!move.arc || std::abs(move.arc->axis.z) < 1 - 1e-12) return move;
  const CutArc& arc = *move.arc;
  const Vec2 center(arc.center_mm);
  const Vec2 begin = Vec2(move.from_mm) - center, end = Vec2(move.to_mm) - center;
  const double inner = glm::length(begin), outer = glm::length(end);
  const double off = std::abs(inner - outer);
  if (off < kSameRadius_mm || off > kRounded_mm || inner < kRounded_mm || outer < kRounded_mm)
    return move;
  CutMove circle = move;
  const double sweep = arc.sweep_rad * arc.axis.z;
  if (std::abs(sweep) <= kMostThroughEnds_rad) {
    const Vec2 half = 0.5 * (end - begin);
    const Vec2 at = center + 0.5 * (begin + end) + Vec2(-half.y, half.x) / std::tan(sweep / 2);
    circle.arc->center_mm.x = at.x, circle.arc->center_mm.y = at.y;
    return circle;
  }
  const double radius = 0.5 * (inner + outer);
  const Vec2 from = center + begin * (radius / inner), to = center + end * (radius / outer);
  circle.from_mm.x = from.x, circle.from_mm.y = from.y;
  circle.to_mm.x = to.x, circle.to_mm.y = to.y;
  return circle;
}

}  // namespace kerf
