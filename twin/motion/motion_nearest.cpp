#include "twin/motion/motion_nearest.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Passages of an arc this close to the nearest one count as equally near.
constexpr double kSamePlace_mm = 1e-3;
/// Of the refinement along helices and spirals.
constexpr int kRefinements = 3;
/// Of arcs on which axes turn: a piece of 0.1 rad becomes shorter than 1e-7 of it.
constexpr int kThirds = 40;

PointOnWay nearest_on_line(const Motion& m, const Vec3& place, double from_t, double to_t) {
  const Vec3 way = m.to_mm - m.from_mm;
  const double square = glm::dot(way, way);
  double t = from_t;
  if (square > 0) t = std::clamp(glm::dot(place - m.from_mm, way) / square, from_t, to_t);
  return {t, glm::length(place - (m.from_mm + t * way))};
}

/// An arc seen from its axis.
struct AxisView {
  explicit AxisView(const Motion& m) : arc(m.arc) {
    const Vec3 d0 = m.from_mm - arc.center_mm;
    const Vec3 d1 = m.to_mm - arc.center_mm;
    along0 = glm::dot(d0, arc.axis);
    along1 = glm::dot(d1, arc.axis);
    const Vec3 across0 = d0 - along0 * arc.axis;
    r0 = glm::length(across0);
    r1 = glm::length(d1 - along1 * arc.axis);
    if (r0 > 0) {
      u = across0 / r0;
      v = glm::cross(arc.axis, u);
    }
  }

  /// Height, radius and angle from the start, of a place.
  void look_at(const Vec3& place) {
    const Vec3 d = place - arc.center_mm;
    along = glm::dot(d, arc.axis);
    x = glm::dot(d, u);
    y = glm::dot(d, v);
  }

  double distance(double t) const {
    const double angle = t * arc.sweep_rad;
    const double radius = r0 + t * (r1 - r0);
    const double dx = x - radius * portable::cos(angle);
    const double dy = y - radius * portable::sin(angle);
    const double dz = along - (along0 + t * (along1 - along0));
    return std::sqrt(dx * dx + dy * dy + dz * dz);
  }

  /// Gauss-Newton on the square of the distance.
  double refined(double t) const {
    const double growth = r1 - r0;
    const double rise = along1 - along0;
    for (int i = 0; i < kRefinements; ++i) {
      const double angle = t * arc.sweep_rad;
      const double radius = r0 + t * growth;
      const double c = portable::cos(angle), s = portable::sin(angle);
      const double ex = radius * c - x, ey = radius * s - y;
      const double ez = along0 + t * rise - along;
      const double px = growth * c - radius * arc.sweep_rad * s;
      const double py = growth * s + radius * arc.sweep_rad * c;
      const double square = px * px + py * py + rise * rise;
      if (square <= 0) break;
      t -= (ex * px + ey * py + ez * rise) / square;
    }
    return t;
  }

  const ArcGeometry& arc;
  double along0 = 0, along1 = 0, r0 = 0, r1 = 0;
  Vec3 u{1, 0, 0}, v{0, 1, 0};
  double along = 0, x = 0, y = 0;  ///< of the place
};

PointOnWay nearest_on_arc(const Motion& m, const Vec3& place, double from_t, double to_t) {
  AxisView view(m);
  view.look_at(place);
  PointOnWay best{from_t, view.distance(from_t)};
  const auto consider = [&](double t) {
    const double distance = view.distance(t);
    if (distance < best.distance_mm - kSamePlace_mm) best = {t, distance};
  };
  const double sweep = m.arc.sweep_rad;
  if (sweep != 0 && view.r0 > 0) {
    const bool plain = view.along0 == view.along1 && view.r0 == view.r1;
    const double turn = 2 * kPi / std::abs(sweep);  // fraction of the way
    double t = portable::atan2(view.y, view.x) / sweep;
    t += turn * std::ceil((from_t - t) / turn - 1);  // the passage before from_t
    for (; t <= to_t + turn; t += turn) {
      consider(std::clamp(t, from_t, to_t));
      if (!plain) consider(std::clamp(view.refined(t), from_t, to_t));
    }
  }
  consider(to_t);
  return best;
}

/// How far the axes are from those of the motion, as a way, at its start and what is added to its
/// end.
struct TurnedWay {
  TurnedWay(const Motion& m, const TurnedAxes& turned) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!turned.counts[i]) continue;
      const auto axis = static_cast<int>(i);
      const double mm_per_deg = turned.lever_mm * kPi / 180;
      off[axis] = mm_per_deg * (turned.abc_deg[i] - m.from_abc_deg[i]);
      way[axis] = mm_per_deg * (m.to_abc_deg[i] - m.from_abc_deg[i]);
    }
    for (int i = 0; i < 3; ++i) {
      if (!turned.uvw_counts[static_cast<std::size_t>(i)]) continue;
      slide_off[i] = turned.uvw_mm[i] - m.from_uvw_mm[i];
      slide_way[i] = m.to_uvw_mm[i] - m.from_uvw_mm[i];
    }
  }
  bool stands() const { return way == Vec3(0) && slide_way == Vec3(0); }
  double distance(double t) const {
    return portable::hypot(glm::length(off - t * way), glm::length(slide_off - t * slide_way));
  }
  Vec3 off{0}, way{0};
  Vec3 slide_off{0}, slide_way{0};
};

PointOnWay nearest_on_turning_line(const Motion& m, const Vec3& place, const TurnedWay& turned,
                                   double from_t, double to_t) {
  const Vec3 way = m.to_mm - m.from_mm;
  const double square = glm::dot(way, way) + glm::dot(turned.way, turned.way) +
                        glm::dot(turned.slide_way, turned.slide_way);
  double t = from_t;
  if (square > 0) {
    const double along = glm::dot(place - m.from_mm, way) + glm::dot(turned.off, turned.way) +
                         glm::dot(turned.slide_off, turned.slide_way);
    t = std::clamp(along / square, from_t, to_t);
  }
  const double tip_mm = glm::length(place - (m.from_mm + t * way));
  return {t, portable::hypot(tip_mm, turned.distance(t))};
}

/// By trials, and by thirds about the best of them.
PointOnWay nearest_on_turning_arc(const Motion& m, const Vec3& place, const TurnedWay& turned,
                                  double from_t, double to_t) {
  const auto distance = [&](double t) {
    return portable::hypot(glm::length(place - point_at(m, t)), turned.distance(t));
  };
  const int trials = 16 + static_cast<int>(8 * std::abs(m.arc.sweep_rad));
  const double step = (to_t - from_t) / trials;
  PointOnWay best{from_t, distance(from_t)};
  for (int i = 1; i <= trials; ++i) {
    const double t = i == trials ? to_t : from_t + i * step;
    if (const double here = distance(t); here < best.distance_mm - kSamePlace_mm) best = {t, here};
  }
  double low = std::max(from_t, best.t - step);
  double high = std::min(to_t, best.t + step);
  for (int i = 0; i < kThirds; ++i) {
    const double third = (high - low) / 3;
    if (distance(low + third) <= distance(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  const double t = (low + high) / 2;
  if (const double here = distance(t); here < best.distance_mm) best = {t, here};
  return best;
}

}  // namespace

PointOnWay nearest_on(const Motion& m, const Vec3& place_mm, const TurnedAxes& turned,
                      double from_t, double to_t) {
  const TurnedWay axes(m, turned);
  if (axes.stands()) {
    PointOnWay point = nearest_on(m, place_mm, from_t, to_t);
    const double off_mm = axes.distance(0);
    if (off_mm > 0) point.distance_mm = portable::hypot(point.distance_mm, off_mm);
    return point;
  }
  return m.kind == MotionKind::kArc ? nearest_on_turning_arc(m, place_mm, axes, from_t, to_t)
                                    : nearest_on_turning_line(m, place_mm, axes, from_t, to_t);
}

PointOnWay nearest_on(const Motion& m, const Vec3& place_mm, double from_t, double to_t) {
  return m.kind == MotionKind::kArc ? nearest_on_arc(m, place_mm, from_t, to_t)
                                    : nearest_on_line(m, place_mm, from_t, to_t);
}

Motion part_of(const Motion& m, double from_t, double to_t) {
  Motion part = m;
  if (from_t > 0) {
    part.from_mm = point_at(m, from_t);
    for (std::size_t i = 0; i < 3; ++i) {
      part.from_abc_deg[i] += from_t * (m.to_abc_deg[i] - m.from_abc_deg[i]);
    }
    part.from_uvw_mm += from_t * (m.to_uvw_mm - m.from_uvw_mm);
  }
  if (to_t < 1) {
    part.to_mm = point_at(m, to_t);
    for (std::size_t i = 0; i < 3; ++i) {
      part.to_abc_deg[i] = m.from_abc_deg[i] + to_t * (m.to_abc_deg[i] - m.from_abc_deg[i]);
    }
    part.to_uvw_mm = m.from_uvw_mm + to_t * (m.to_uvw_mm - m.from_uvw_mm);
  }
  if (from_t > 0 || to_t < 1) part.arc.sweep_rad = (to_t - from_t) * m.arc.sweep_rad;
  return part;
}

}  // namespace kerf
