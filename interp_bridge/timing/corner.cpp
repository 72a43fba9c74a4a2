// The sizes of the arcs, the shares and the thresholds are those of LinuxCNC 2.9 (its tp folder:
// blendmath.c), so that corners are rounded where it rounds them.
#include "interp_bridge/timing/corner.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"

namespace kerf {
namespace {

/// Share of a segment that a blend may cut away.
constexpr double kBlendShare = 0.5;
/// Without a tolerance a corner may be cut by this share of the shorter arm.
constexpr double kToleranceShare = 0.25;
/// Square of 2 degrees: arms that close fold back on each other, and the machine stops.
constexpr double kReversal = (2.0 * kPi / 180.0) * (2.0 * kPi / 180.0);
/// Angles closer than this to 0 or 180 degrees have no plane.
constexpr double kAngleEpsilon = 1e-6;
/// Blend arcs shorter than this are not made, mm.
constexpr double kLeastArc_mm = 1e-6;
constexpr double kLeastLeft_mm = 1e-6;
/// Arcs are blended only within their plane; sine of the tilt that still counts as within.
constexpr double kCoplanar = 1e-4;

double programmed_speed(const Segment& segment) {
  return std::min(segment.request, segment.max_speed);
}

double blend_tolerance(const Segment& previous, const Segment& next) {
  const double reach0 = previous.nominal_mm * kToleranceShare;
  const double reach1 = next.nominal_mm * kToleranceShare;
  const double wanted0 = previous.tolerance_mm > 0 ? previous.tolerance_mm : reach0;
  const double wanted1 = next.tolerance_mm > 0 ? next.tolerance_mm : reach1;
  return std::min({wanted0, wanted1, reach0, reach1});
}

/// The largest disc that an ellipsoid of limits leaves in the plane across `normal`.
double least_in_plane(const Vec3& normal, const Vec3& limits) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (limits[i] <= 0) continue;
    const double across = std::sqrt(std::max(0.0, 1.0 - normal[i] * normal[i]));
    if (across > 0) least = std::min(least, limits[i] / across);
  }
  return least;
}

/// Numbers of one blend while it is made.
struct BlendPlan {
  double cos_turn = 1;  ///< of the change of direction
  double sin_half = 0;  ///< of theta, half the angle between the arms
  double cos_half = 0;
  double turn = 0;    ///< change of direction that the arc makes, radians
  Vec3 u0{0}, u1{0};  ///< arms
  Vec3 binormal{0}, normal{0};
  double room0 = 0, room1 = 0;  ///< lengths that may be cut from the arms
  double tolerance = 0;
  double accel = 0;
  double speed = 0;
  double request = 0;
  double radius = 0;
  double trim = 0;
};

/// Half angle between the arms from the arms themselves.
void set_half_angle(BlendPlan& plan) {
  const double c = std::clamp(glm::dot(plan.u0, plan.u1), -1.0, 1.0);
  plan.cos_turn = c;
  plan.cos_half = std::sqrt((1.0 - c) / 2.0);
  plan.sin_half = std::sqrt((1.0 + c) / 2.0);
  plan.turn = portable::acos(c);
}

/// The greatest speed whose X, Y, Z shares stay in bounds on the whole arc between two lines.
double speed_between_lines(const BlendPlan& plan, const Segment& previous, const Segment& next) {
  const double least_cos = 0.031410759;  // cos(0.49 pi): keeps the division finite
  const double c = std::max(plan.cos_turn, least_cos);
  const double v0 = std::min(previous.max_speed, next.max_speed / c);
  const double v1 = std::min(next.max_speed, previous.max_speed / c);
  const double base = glm::length(plan.u1 * v1 - plan.u0 * v0);
  const double sin_turn = std::sqrt(std::max(0.0, 1.0 - plan.cos_turn * plan.cos_turn));
  return base > 0 ? v0 * v1 * sin_turn / base : 0.0;
}

bool start_plan(BlendPlan& plan, const Segment& previous, const Segment& next) {
  plan.u0 = previous.tangent_to;
  plan.u1 = next.tangent_from;
  set_half_angle(plan);
  if (plan.sin_half < kAngleEpsilon || plan.cos_half < kAngleEpsilon) return false;
  const Vec3 across = glm::cross(plan.u0, plan.u1);
  const double size = glm::length(across);
  if (size <= 0) return false;
  plan.binormal = across / size;
  plan.normal = glm::normalize(plan.u1 - plan.u0);
  return true;
}

/// Radius, speed and trim from the room that there is.
bool solve_plan(const AxisRates& rates, BlendPlan& plan, const Segment& previous,
                const Segment& next) {
  plan.tolerance = blend_tolerance(previous, next);
  plan.accel = least_in_plane(plan.binormal, rates.acceleration);
  if (!std::isfinite(plan.accel)) return false;
  const double across = plan.accel * kAcrossShare;
  plan.request = std::max(programmed_speed(previous), programmed_speed(next));
  double fastest = least_in_plane(plan.binormal, rates.velocity);
  if (previous.shape == SegmentShape::kLine && next.shape == SegmentShape::kLine) {
    fastest = std::max(fastest, speed_between_lines(plan, previous, next));
  }
  const double goal = std::min(plan.request, fastest);

  const double by_tolerance = plan.cos_half * plan.tolerance / (1.0 - plan.sin_half);
  const double room = std::min({plan.room0, plan.room1, by_tolerance});
  const double tan_half = plan.sin_half / plan.cos_half;
  const double widest = tan_half * room;
  plan.speed = std::min(std::sqrt(across * widest), goal);
  // Long arms: only as wide as the speed needs. Short arms: as wide as a parabola would take.
  const double half = plan.accel * 0.5;
  const double peak = std::sqrt(2.0 * half * room);
  const double parabola = std::min(peak, plan.speed) / half * plan.speed / plan.turn;
  plan.radius = std::max(plan.speed * plan.speed / across, std::min(parabola, widest));
  plan.trim = plan.radius / tan_half;
  return plan.radius * plan.turn >= kLeastArc_mm;
}

/// One arm that is an arc: bends the arm towards its chord where the arc turns to the same side.
struct CurvedArm {
  bool inside = false;  ///< the blend lies inside the circle
  double most_rad = 0;  ///< angle that may be cut away
  double radius = 0;
};

CurvedArm curve_arm(BlendPlan& plan, const Segment& arc, bool at_end) {
  CurvedArm arm;
  const Vec3 corner = at_end ? arc.to : arc.from;
  const Vec3 other = at_end ? plan.u1 : plan.u0;
  const double outward = glm::dot(other, corner - arc.arc.center_mm);
  arm.inside = at_end ? outward < 0 : outward >= 0;
  arm.radius = arc.radius_mm;
  const double half_angle = portable::atan2(plan.sin_half, plan.cos_half);
  const double left = std::abs(arc.arc.sweep_rad) - arc.trim_from - arc.trim_to;
  const double share = at_end ? 2.0 / 3.0 : 1.0 / 3.0;
  arm.most_rad = std::min(left * share, arm.inside ? half_angle : kPi / 2);
  return arm;
}

void bend_arm(BlendPlan& plan, const Segment& arc, const CurvedArm& arm, bool at_end,
              double& theta) {
  double& room = at_end ? plan.room0 : plan.room1;
  if (!arm.inside) {
    room = arm.most_rad * arm.radius;
    return;
  }
  const double whole = std::abs(arc.arc.sweep_rad);
  if (at_end) {
    plan.u0 = glm::normalize(arc.to - arc.arc_point(whole - arm.most_rad / 2));
  } else {
    plan.u1 = glm::normalize(arc.arc_point(arm.most_rad / 2) - arc.from);
  }
  room = portable::sin(arm.most_rad / 4) * arm.radius;
  theta -= arm.most_rad / 4;
}

/// Angle that the blend's centre and the corner span about an arc's centre: what is cut from it.
double trim_angle(const Vec3& corner, const Vec3& blend_center, const Vec3& arc_center) {
  const Vec3 a = glm::normalize(corner - arc_center);
  const Vec3 b = glm::normalize(blend_center - arc_center);
  return portable::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

struct BlendPlace {
  Vec3 center{0};
  double trim0 = 0, trim1 = 0;  ///< mm of lines, radians of arcs
};

/// Centre of a circle of plan.radius that touches a line through `corner` along u and the arc.
bool place_at_line(const BlendPlan& plan, const Vec3& corner, const Vec3& u, bool line_first,
                   const Segment& arc, const CurvedArm& arm, BlendPlace& place) {
  const Vec3 n = glm::normalize(glm::cross(plan.binormal, u));
  const Vec3 to_center = arc.arc.center_mm - corner;
  const double along = glm::dot(to_center, u);
  const double across = glm::dot(to_center, n);
  const double reach = arm.radius + (arm.inside ? -plan.radius : plan.radius);
  const double gap = plan.radius - across;
  const double square = reach * reach - gap * gap;
  if (square < 0) return false;
  const double root = std::sqrt(square);
  const double way = std::min(std::abs(-along + root), std::abs(-along - root));
  place.center = corner + (line_first ? -way : way) * u + plan.radius * n;
  (line_first ? place.trim0 : place.trim1) = way;
  (line_first ? place.trim1 : place.trim0) = trim_angle(corner, place.center, arc.arc.center_mm);
  return true;
}

bool place_between_arcs(const BlendPlan& plan, const Vec3& corner, const Segment& previous,
                        const Segment& next, const CurvedArm& arm0, const CurvedArm& arm1,
                        BlendPlace& place) {
  const Vec3 c0 = previous.arc.center_mm;
  const Vec3 c1 = next.arc.center_mm;
  const double apart = glm::length(c1 - c0);
  if (apart <= 0) return false;
  const double d0 = arm0.radius + (arm0.inside ? -plan.radius : plan.radius);
  const double d1 = arm1.radius + (arm1.inside ? -plan.radius : plan.radius);
  const Vec3 x = (c1 - c0) / apart;
  const Vec3 y = glm::cross(plan.binormal, x);
  const double along = (d0 * d0 - d1 * d1 + apart * apart) / (2.0 * apart);
  const double square = d0 * d0 - along * along;
  if (square < 0) return false;
  const double root = std::sqrt(square);
  const Vec3 one = c0 + along * x + root * y;
  const Vec3 two = c0 + along * x - root * y;
  place.center = glm::length(one - corner) <= glm::length(two - corner) ? one : two;
  place.trim0 = trim_angle(corner, place.center, c0);
  place.trim1 = trim_angle(corner, place.center, c1);
  return true;
}

bool coplanar(const Vec3& binormal, const Segment& arc) {
  return glm::length(glm::cross(binormal, arc.arc.axis)) < kCoplanar;
}

/// Everything between two segments of which at least one is an arc.
bool plan_with_arcs(const AxisRates& rates, BlendPlan& plan, const Segment& previous,
                    const Segment& next, BlendPlace& place) {
  const bool arc0 = previous.shape == SegmentShape::kArc;
  const bool arc1 = next.shape == SegmentShape::kArc;
  if (arc0 && !coplanar(plan.binormal, previous)) return false;
  if (arc1 && !coplanar(plan.binormal, next)) return false;
  const Vec3 corner = next.from;
  double theta = portable::atan2(plan.sin_half, plan.cos_half);
  CurvedArm arm0, arm1;
  if (arc0) arm0 = curve_arm(plan, previous, true);
  if (arc1) arm1 = curve_arm(plan, next, false);
  plan.room0 = std::min(previous.length_mm, previous.nominal_mm * kBlendShare);
  plan.room1 = next.nominal_mm * kBlendShare;
  if (arc0) bend_arm(plan, previous, arm0, true, theta);
  if (arc1) bend_arm(plan, next, arm1, false, theta);
  // Between two arcs, and only there, LinuxCNC refuses tight corners.
  if (theta < (arc0 && arc1 ? kPi / 12 : kAngleEpsilon)) return false;
  plan.sin_half = portable::sin(theta);
  plan.cos_half = portable::cos(theta);
  plan.turn = kPi - 2 * theta;
  if (!solve_plan(rates, plan, previous, next)) return false;
  bool placed = false;
  if (arc0 && arc1) {
    placed = place_between_arcs(plan, corner, previous, next, arm0, arm1, place);
  } else if (arc0) {
    placed = place_at_line(plan, corner, plan.u1, false, previous, arm0, place);
  } else {
    placed = place_at_line(plan, corner, plan.u0, true, next, arm1, place);
  }
  if (!placed || glm::length(place.center - corner) - plan.radius > plan.tolerance) return false;
  if (place.trim0 > (arc0 ? arm0.most_rad : previous.length_mm)) return false;
  return place.trim1 <= (arc1 ? arm1.most_rad : next.length_mm);
}

/// The segment after `amount` (mm of a line, radians of an arc) is cut from one of its ends.
void trim(Segment& segment, double amount, bool at_end) {
  const double before_mm = segment.length_mm;
  (at_end ? segment.trim_to : segment.trim_from) += amount;
  if (segment.shape == SegmentShape::kArc) {
    const double whole = std::abs(segment.arc.sweep_rad);
    segment.length_mm *= (whole - segment.trim_from - segment.trim_to) /
                         (whole - segment.trim_from - segment.trim_to + amount);
  } else {
    segment.length_mm -= amount;
  }
  const double left = before_mm > 0 ? segment.length_mm / before_mm : 1;
  at_end ? keep_slowness(segment, 0, left) : keep_slowness(segment, 1 - left, 1);
}

Vec3 trimmed_end(const Segment& segment, double amount, bool at_end) {
  if (segment.shape == SegmentShape::kArc) {
    const double whole = std::abs(segment.arc.sweep_rad);
    return segment.arc_point(at_end ? whole - amount : amount);
  }
  return at_end ? segment.to - amount * segment.tangent_to
                : segment.from + amount * segment.tangent_from;
}

/// The blend as a segment; its ends lie on the arms.
bool make_blend(const AxisRates& rates, const BlendPlan& plan, const BlendPlace& place,
                const Segment& previous, const Segment& next, Segment& blend) {
  blend = Segment{};
  blend.shape = SegmentShape::kBlend;
  blend.traverse = previous.traverse;
  blend.end = SegmentEnd::kTangent;
  blend.finalized = true;
  blend.from = trimmed_end(previous, place.trim0, true);
  blend.to = trimmed_end(next, place.trim1, false);
  const Vec3 r0 = blend.from - place.center;
  const Vec3 r1 = blend.to - place.center;
  blend.radius_mm = glm::length(r0);
  if (blend.radius_mm <= 0) return false;
  const double c = glm::dot(r0, r1) / (blend.radius_mm * glm::length(r1));
  blend.arc = {place.center, plan.binormal, portable::acos(std::clamp(c, -1.0, 1.0))};
  blend.length_mm = blend.radius_mm * blend.arc.sweep_rad;
  if (blend.length_mm < kLeastArc_mm) return false;
  blend.nominal_mm = blend.length_mm;
  blend.tangent_from = previous.tangent_to;
  blend.tangent_to = next.tangent_from;
  blend.request = plan.request;
  blend.spindle_speed = next.slow_from > 0 ? 1 / next.slow_from : next.spindle_speed;
  blend.max_speed = plan.speed;
  blend.max_accel = plan.accel;
  blend.along_share = kAlongShare;
  clamp_to_cycle(blend, rates.cycle_s);
  return true;
}

/// Nearly straight corners: how fast they may be run through as they are. True: at full speed.
bool measure_kink(const AxisRates& rates, Segment& previous, Segment& next) {
  const double speed = std::min(programmed_speed(previous), programmed_speed(next));
  // The change of velocity happens within one servo period.
  const double jolt = speed / rates.cycle_s + next.max_accel;
  const Vec3 change = (next.tangent_from - previous.tangent_to) * jolt;
  double load = 0;
  for (int i = 0; i < 3; ++i) {
    load = std::max(load, std::abs(change[i]) * rates.inertia[static_cast<std::size_t>(i)]);
  }
  const bool curved = previous.shape == SegmentShape::kArc || next.shape == SegmentShape::kArc;
  if (curved) load /= kAlongShare;
  const bool straight = load < rates.kink_ratio;
  previous.corner_speed = straight ? speed : speed * rates.kink_ratio / load;
  const double kept = straight ? load : rates.kink_ratio;
  previous.corner_load = std::max(previous.corner_load, kept);
  next.corner_load_from = std::max(next.corner_load_from, kept);
  return straight;
}

void forget_kink(Segment& previous, Segment& next) {
  previous.corner_speed = -1;
  previous.corner_load = 0;
  next.corner_load_from = 0;
}

/// Shape and ends of the blend between two segments that a blend is possible for.
bool plan_blend(const AxisRates& rates, const Segment& previous, const Segment& next,
                BlendPlan& plan, BlendPlace& place, Segment& blend) {
  if (!start_plan(plan, previous, next)) return false;
  if (previous.shape == SegmentShape::kLine && next.shape == SegmentShape::kLine) {
    plan.room0 = std::min(previous.length_mm, previous.nominal_mm * kBlendShare);
    plan.room1 = next.length_mm * kBlendShare;
    if (!solve_plan(rates, plan, previous, next)) return false;
    place.center = next.from + plan.normal * (plan.radius / plan.sin_half);
    place.trim0 = place.trim1 = plan.trim;
  } else if (!plan_with_arcs(rates, plan, previous, next, place)) {
    return false;
  }
  return make_blend(rates, plan, place, previous, next, blend);
}

CornerKind put_blend(const AxisRates& rates, const BlendPlace& place, Segment& previous,
                     Segment& next, Segment& blend) {
  forget_kink(previous, next);
  next.begins_parabolic = false;
  blend.tolerance_mm = previous.tolerance_mm;
  const bool line = previous.shape == SegmentShape::kLine;
  const double left = previous.length_mm - place.trim0;
  const bool swallow = line && !previous.begins_parabolic && !previous.keeps_start &&
                       left < rates.gap_s * blend.max_speed;
  trim(next, place.trim1, false);
  if (swallow) {
    blend.lead_mm = std::max(left, 0.0);
    blend.from = blend.from - blend.lead_mm * previous.tangent_to;
    blend.length_mm += blend.lead_mm;
    blend.corner_load_from = previous.corner_load_from;
    return CornerKind::kSwallowed;
  }
  // What is left of a line that keeps its start may be next to nothing: it takes a servo period.
  trim(previous, line ? std::min(place.trim0, previous.length_mm - kLeastLeft_mm) : place.trim0,
       true);
  previous.end = SegmentEnd::kTangent;
  return CornerKind::kBlend;
}

}  // namespace

namespace {

/// Of an arc, across its axis.
Vec3 tangent_across(const Segment& arc, const Vec3& at) {
  const Vec3 way = glm::cross(arc.arc.axis, at - arc.arc.center_mm);
  return glm::normalize(arc.arc.sweep_rad < 0 ? -way : way);
}

/// What LinuxCNC takes for the directions of the accelerations at a corner that is overlapped in
/// time: those of lines, of an arc that ends without its rise, of one that begins also without, and
/// bent inwards by what the turning takes at half of its speed.
Vec3 braking_direction(const Segment& segment) {
  return segment.shape == SegmentShape::kArc ? tangent_across(segment, segment.to)
                                             : segment.tangent_to;
}

Vec3 speeding_direction(const Segment& segment) {
  if (segment.shape != SegmentShape::kArc) return segment.tangent_from;
  const Vec3 out = segment.arc.center_mm - segment.from;
  const Vec3 inwards = glm::normalize(out - glm::dot(out, segment.arc.axis) * segment.arc.axis);
  // Of a feed per revolution LinuxCNC has its few mm for a speed here.
  const double speed = segment.follows_spindle() ? 0.0 : segment.request;
  const double turning = speed * speed / 4 / segment.radius_mm;
  return glm::normalize(tangent_across(segment, segment.from) * segment.overall_accel() +
                        inwards * turning);
}

}  // namespace

ParabolicSpeeds parabolic_speeds(const Segment& previous, const Segment& next, double target_before,
                                 double target_after) {
  const double a0 = previous.accel();
  const double a1 = next.accel();
  const double way1 = next.finalized ? next.length_mm : next.length_mm / 2;
  const double way0 = previous.finalized ? previous.length_mm : previous.length_mm / 2;
  const double v0 = std::min(std::sqrt(a0 * way0), target_before);
  const double v1 = std::min(std::sqrt(a1 * way1), target_after);
  const double longest = std::min(previous.length_mm / v0, next.length_mm / v1);
  const double time = std::min(longest, std::max(v0 / a0, v1 / a1));
  ParabolicSpeeds speeds;
  speeds.leaving = std::min(v0, time * a0);
  speeds.entering = std::min(v1, time * a1);
  const double c =
      std::clamp(glm::dot(braking_direction(previous), speeding_direction(next)), -1.0, 1.0);
  const double cos_half = std::sqrt((1.0 - c) / 2.0);
  if (previous.tolerance_mm > 0 && cos_half > kAngleEpsilon) {
    const double most = 2.0 * std::sqrt(a0 * previous.tolerance_mm / cos_half);
    speeds.leaving = std::min(speeds.leaving, most);
    speeds.entering = std::min(speeds.entering, most);
  }
  speeds.along = std::sqrt((1.0 + c) / 2.0) * (speeds.leaving + speeds.entering) / 2.0;
  return speeds;
}

CornerKind join_corner(const AxisRates& rates, Segment& previous, Segment& next, Segment& blend) {
  if (previous.traverse != next.traverse) previous.end = SegmentEnd::kStop;
  if (previous.end == SegmentEnd::kStop || previous.half_run) return CornerKind::kPlain;
  if (!rates.arc_blend || previous.extra || next.extra) return CornerKind::kPlain;
  const Vec3 sum = previous.tangent_to + next.tangent_from;
  if (glm::dot(sum, sum) < kReversal) {
    previous.end = SegmentEnd::kStop;
    return CornerKind::kPlain;
  }
  if (measure_kink(rates, previous, next)) {
    previous.end = SegmentEnd::kTangent;
    return CornerKind::kPlain;
  }
  if (previous.end == SegmentEnd::kExact) return CornerKind::kPlain;

  // Three ways to go on; the fastest is taken. Parabolas count half: they halve the acceleration
  // of both segments.
  const double parabolic =
      parabolic_speeds(previous, next, programmed_speed(previous), programmed_speed(next)).along /
      2;
  const double kink = previous.corner_speed;
  BlendPlan plan;
  BlendPlace place;
  if (plan_blend(rates, previous, next, plan, place, blend) && blend.max_speed > kink &&
      blend.max_speed > parabolic) {
    return put_blend(rates, place, previous, next, blend);
  }
  if (kink >= parabolic) {
    previous.end = SegmentEnd::kTangent;
  } else {
    forget_kink(previous, next);
    previous.end = SegmentEnd::kParabolic;
    next.begins_parabolic = true;
  }
  return CornerKind::kPlain;
}

}  // namespace kerf
