#include "twin/process/milling/upright_arc.h"

#include <glm/geometric.hpp>

#include "twin/process/milling/way_profile.h"

namespace kerf {
namespace {

constexpr double kLevelAxis = 1e-9;
constexpr double kLeastRadius_mm = 1e-3;
/// Where it turns back so near to an end it does not: a quarter of a circle ends there, to the
/// digits of I and K, and goes 0.00005 of its radius back at most.
constexpr double kAtEnd_rad = 0.01;
/// So little of a way that goes straight up or down is level.
constexpr double kLevelShare = 0.05;

}  // namespace

std::optional<UprightArc> UprightArc::of(const CutMove& move) {
  if (!move.arc || !move.is_vertical() || std::abs(move.arc->axis.z) > kLevelAxis)
    return std::nullopt;
  const CutArc& arc = *move.arc;
  if (arc.sweep_rad == 0) return std::nullopt;
  UprightArc out;
  out.move_ = move;
  out.axis_ = arc.axis;
  out.across_ = Vec3(-arc.axis.y, arc.axis.x, 0);
  const Vec3 from = move.from_mm - arc.center_mm, to = move.to_mm - arc.center_mm;
  out.center_along_ = glm::dot(from, arc.axis);
  out.climb_mm_ = glm::dot(to, arc.axis) - out.center_along_;
  const Vec2 begin(glm::dot(from, out.across_), from.z), end(glm::dot(to, out.across_), to.z);
  out.r0_ = glm::length(begin), out.r1_ = glm::length(end);
  if (std::min(out.r0_, out.r1_) < kLeastRadius_mm || std::abs(out.r0_ - out.r1_) > kRounded_mm)
    return std::nullopt;
  out.start_ = std::atan2(begin.y, begin.x);
  out.sweep_ = arc.sweep_rad;
  return out;
}

Vec3 UprightArc::point_at(double part) const {
  const double angle = angle_at(part), r = r0_ + part * (r1_ - r0_);
  return move_.arc->center_mm + (center_along_ + part * climb_mm_) * axis_ +
         r * (std::cos(angle) * across_ + std::sin(angle) * Vec3(0, 0, 1));
}

std::vector<double> UprightArc::turning_parts() const {
  std::vector<double> parts;
  // Level with its centre it goes straight up or down.
  const double low = std::min(start_, start_ + sweep_), high = std::max(start_, start_ + sweep_);
  for (double at = std::ceil(low / kPi) * kPi; at < high; at += kPi) {
    if (at - low > kAtEnd_rad && high - at > kAtEnd_rad) parts.push_back(part_of(at));
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

bool UprightArc::is_hill(double from, double to) const {
  return std::sin(angle_at(0.5 * (from + to))) > 0;
}

CutMove UprightArc::line_at(double at, double until) const {
  const double angle = angle_at(at), turn = sweep_ < 0 ? -1 : 1;
  const double r = r0_ + at * (r1_ - r0_);
  Vec3 way = r * sweep_ * (-std::sin(angle) * across_ + std::cos(angle) * Vec3(0, 0, 1)) +
             climb_mm_ * axis_;
  const double long_mm = glm::length(way);
  if (glm::length(Vec2(way)) < kLevelShare * long_mm) {
    // Which way it goes on, or has come: to where it is level, over or under the centre.
    const double middle = angle_at(0.5 * (at + until));
    way += kLevelShare * long_mm * (std::sin(middle) * turn > 0 ? -1.0 : 1.0) * across_;
  }
  const Vec3 from = point_at(at), end = point_at(until);
  const Vec2 level(way), rest = Vec2(end) - Vec2(from);
  const double length2 = glm::dot(level, level);
  const double reach = length2 > 0 ? std::max(glm::dot(rest, level) / length2, 0.0) : 0.0;
  CutMove line = move_;
  line.arc.reset();
  // As it is told by a part of its way, it begins as far before the place as it ends behind it.
  line.from_mm = from - reach * way;
  line.to_mm = from + reach * way;
  return line;
}

}  // namespace kerf
