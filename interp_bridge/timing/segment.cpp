#include "interp_bridge/timing/segment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "base/triple.h"

namespace kerf {
namespace {

/// An arc taken apart: height along the axis, vectors across it.
struct ArcParts {
  Vec3 across_from{0};
  double radius_from = 0;
  double radius_to = 0;
  double rise = 0;
};

ArcParts arc_parts(const Vec3& from, const Vec3& to, const ArcGeometry& arc) {
  ArcParts parts;
  const Vec3 d0 = from - arc.center_mm;
  const Vec3 d1 = to - arc.center_mm;
  const double along0 = glm::dot(d0, arc.axis);
  const double along1 = glm::dot(d1, arc.axis);
  parts.across_from = d0 - along0 * arc.axis;
  parts.radius_from = glm::length(parts.across_from);
  parts.radius_to = glm::length(d1 - along1 * arc.axis);
  parts.rise = along1 - along0;
  return parts;
}

double inverse(double limit) { return limit > 0 && std::isfinite(limit) ? 1.0 / limit : 0.0; }

/// The least limit among the axes that turn about `axis`.
double least_across(const Vec3& axis, const Vec3& limit) {
  double least = kUnlimited;
  for (int i = 0; i < 3; ++i) {
    // An axis that stands along the arc's own takes no part in the turning.
    const bool takes_part = std::abs(axis[i]) < 0.9999;
    if (takes_part && limit[i] > 0) least = std::min(least, limit[i]);
  }
  return least;
}

}  // namespace

AxisRates::AxisRates(const MachineLimits& limits)
    : linear_cap(limits.max_linear_velocity_mm_per_s),
      angular_cap(limits.max_angular_velocity_deg_per_s),
      cycle_s(limits.servo_period_s),
      kink_ratio(std::clamp(limits.arc_blend_kink_ratio, 0.001, 0.7071)),
      gap_s(limits.arc_blend_gap_cycles * limits.servo_period_s),
      arc_blend(limits.arc_blend),
      depth(std::max(limits.arc_blend_depth, 2)) {
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    const AxisLimits& axis = limits.axes[i];
    if (!axis.present) continue;
    slowness[i] = inverse(axis.max_velocity);
    inertia[i] = inverse(axis.max_acceleration);
    if (i < 3) {
      velocity[static_cast<int>(i)] = axis.max_velocity;
      acceleration[static_cast<int>(i)] = axis.max_acceleration;
    }
  }
}

ExtraWay extra_way(const Motion& m) {
  ExtraWay way;
  for (std::size_t i = 0; i < 3; ++i) way.abc_deg[i] = m.to_abc_deg[i] - m.from_abc_deg[i];
  way.uvw_mm = m.to_uvw_mm - m.from_uvw_mm;
  return way;
}

StraightRates straight_rates(const AxisRates& rates, const Vec3& delta_mm, const ExtraWay& extra) {
  StraightRates result;
  double time = 0;
  double time2 = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double way = std::abs(delta_mm[static_cast<int>(i)]);
    time = std::max(time, way * rates.slowness[i]);
    time2 = std::max(time2, way * rates.inertia[i]);
  }
  const double linear = glm::length(delta_mm);
  if (linear > 0 && is_equal(extra.abc_deg, {}) && is_equal(extra.uvw_mm, Vec3{0})) {
    result.tip = result.linear = true;
    result.length = linear;
    result.speed = time > 0 ? std::min(linear / time, kUnlimited) : kUnlimited;
    result.accel_s2 = time2;
    return result;
  }
  const auto add = [&](double way, std::size_t axis, double& square) {
    if (way == 0) return;
    square += way * way;
    time = std::max(time, std::abs(way) * rates.slowness[axis]);
    time2 = std::max(time2, std::abs(way) * rates.inertia[axis]);
  };
  double turned = 0;
  double slid = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    add(extra.abc_deg[i], i + 3, turned);
    add(extra.uvw_mm[static_cast<int>(i)], i + 6, slid);
  }
  result.tip = linear > 0;
  result.linear = result.tip || slid > 0;
  result.extra = turned > 0 || slid > 0;
  result.length = result.tip ? linear : std::sqrt(slid > 0 ? slid : turned);
  result.speed = time > 0 ? std::min(result.length / time, kUnlimited) : kUnlimited;
  result.accel_s2 = time2;
  return result;
}

Segment make_line(const Vec3& from, const Vec3& to, const StraightRates& straight, double speed) {
  Segment segment;
  segment.extra = straight.extra;
  segment.linear = straight.linear;
  segment.from = from;
  segment.to = to;
  segment.length_mm = straight.length;
  segment.nominal_mm = straight.length;
  segment.max_speed = straight.speed;
  segment.request = std::min(speed, straight.speed);
  segment.max_accel = straight.accel();
  if (straight.tip) {
    segment.tangent_from = (to - from) / straight.length;
  } else {
    // LinuxCNC gives moves of the other axes alone the direction of X where it measures corners.
    segment.tangent_from = {1, 0, 0};
  }
  segment.tangent_to = segment.tangent_from;
  return segment;
}

bool has_radius(const Motion& motion) {
  const ArcParts parts = arc_parts(motion.from_mm, motion.to_mm, motion.arc);
  return std::min(parts.radius_from, parts.radius_to) > kLeastRadius_mm;
}

Segment make_arc(const AxisRates& rates, const Motion& motion, double speed) {
  const ArcParts parts = arc_parts(motion.from_mm, motion.to_mm, motion.arc);
  const double turn = std::abs(motion.arc.sweep_rad);
  const double growth = parts.radius_to - parts.radius_from;
  const double around = turn * 0.5 * (parts.radius_from + parts.radius_to);
  const double planar = portable::hypot(around, growth);
  Segment segment;
  segment.shape = SegmentShape::kArc;
  segment.from = motion.from_mm;
  segment.to = motion.to_mm;
  segment.arc = motion.arc;
  segment.radius_mm = std::min(parts.radius_from, parts.radius_to);
  segment.length_mm = portable::hypot(planar, parts.rise);
  segment.nominal_mm = segment.length_mm;

  const StraightRates chord =
      straight_rates(rates, motion.to_mm - motion.from_mm, extra_way(motion));
  segment.extra = chord.extra;
  const double accel = least_across(motion.arc.axis, rates.acceleration);
  const double across = std::sqrt(accel * kAcrossShare * segment.radius_mm);
  const double planar_speed = std::min(across, least_across(motion.arc.axis, rates.velocity));
  const double time = std::max(planar / planar_speed, chord.length / chord.speed);
  const double time2 = std::max(planar / accel, chord.length / chord.accel());
  segment.max_speed = segment.length_mm / time;
  segment.max_accel = segment.length_mm / time2;
  segment.request = std::min(speed, segment.max_speed);
  segment.along_share = kAlongShare;

  const Vec3 out0 = parts.across_from / parts.radius_from;
  const double sign = motion.arc.sweep_rad < 0 ? -1.0 : 1.0;
  const auto tangent = [&](const Vec3& out, double radius) {
    const Vec3 around_dir = sign * glm::cross(motion.arc.axis, out);
    return glm::normalize(around_dir * (radius * turn) + motion.arc.axis * parts.rise +
                          out * growth);
  };
  segment.tangent_from = tangent(out0, parts.radius_from);
  const Vec3 d1 = motion.to_mm - motion.arc.center_mm;
  const Vec3 out1 = glm::normalize(d1 - glm::dot(d1, motion.arc.axis) * motion.arc.axis);
  segment.tangent_to = tangent(out1, parts.radius_to);
  return segment;
}

Vec3 Segment::arc_point(double angle) const {
  const ArcParts parts = arc_parts(from, to, arc);
  const double turn = std::abs(arc.sweep_rad);
  const double part = turn > 0 ? angle / turn : 0.0;
  const Vec3 out = parts.across_from / parts.radius_from;
  const Vec3 side = glm::cross(arc.axis, out) * (arc.sweep_rad < 0 ? -1.0 : 1.0);
  const double radius = parts.radius_from + part * (parts.radius_to - parts.radius_from);
  const Vec3 foot = from - parts.across_from;
  return foot + part * parts.rise * arc.axis +
         radius * (portable::cos(angle) * out + portable::sin(angle) * side);
}

Vec3 Segment::point_at(double way_mm) const {
  if (shape == SegmentShape::kArc) {
    const double left = std::abs(arc.sweep_rad) - trim_from - trim_to;
    return arc_point(trim_from + (length_mm > 0 ? left * way_mm / length_mm : 0.0));
  }
  return from + (trim_from + way_mm) * tangent_from;
}

void follow_spindle(Segment& segment, const SpindleFeed& feed) {
  segment.request = segment.max_speed;
  segment.spindle_speed = feed.mean;
  segment.slow_from = feed.slow_from;
  segment.slow_to = feed.slow_to;
}

void keep_slowness(Segment& segment, double from, double to) {
  if (segment.slow_from <= 0 || from >= to) return;
  WayInTime law;
  law.set_slowness(segment.slow_from, segment.slow_to, 1 / segment.spindle_speed);
  const double time = law.time_of(to) - law.time_of(from);
  if (time <= 0) return;
  segment.spindle_speed *= (to - from) / time;
  const double unit = segment.slow_from;
  segment.slow_from = unit * law.slowness_at(from);
  segment.slow_to = unit * law.slowness_at(to);
}

void clamp_to_cycle(Segment& segment, double cycle_s) {
  segment.max_speed = std::min(segment.max_speed, segment.length_mm / cycle_s);
}

void finalize(Segment& segment, double cycle_s) {
  if (segment.finalized) return;
  clamp_to_cycle(segment, cycle_s);
  segment.finalized = true;
  if (segment.shape != SegmentShape::kArc) return;
  const double load = std::max(segment.corner_load, segment.corner_load_from);
  double accel = segment.max_accel * (1.0 - load);
  if (segment.begins_parabolic || segment.end == SegmentEnd::kParabolic) accel *= 0.5;
  // The planner's measure of a helix: curvature of the circle, relaxed by its rise.
  const double rise = glm::dot(segment.to - segment.from, segment.arc.axis);
  const double radius = segment.radius_mm + rise * rise / segment.radius_mm;
  const double across = segment.max_speed * segment.max_speed / radius;
  if (across > kAcrossShare * accel) {
    segment.max_speed = std::sqrt(kAcrossShare * accel * radius);
    segment.along_share = kAlongShare;
  } else {
    const double used = across / accel;
    segment.along_share = std::sqrt(1.0 - used * used);
  }
}

}  // namespace kerf
