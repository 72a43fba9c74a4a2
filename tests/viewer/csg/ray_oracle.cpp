#include "tests/viewer/csg/ray_oracle.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

Span all() { return {-kForever, kForever}; }

/// normal . x <= limit
Span half_space(const Ray& ray, const Vec3& normal, double limit) {
  const double slope = glm::dot(normal, ray.direction);
  const double rest = limit - glm::dot(normal, ray.origin);
  if (std::abs(slope) < 1e-12) return rest >= 0.0 ? all() : Span{};
  return slope > 0.0 ? Span{-kForever, rest / slope} : Span{rest / slope, kForever};
}

/// a s^2 + 2 b s + c <= 0, a > 0
Span between_roots(double a, double b, double c) {
  const double d = b * b - a * c;
  if (!(d > 0.0)) return {};
  return {(-b - std::sqrt(d)) / a, (-b + std::sqrt(d)) / a};
}

Span sphere(const Ray& ray, const Vec3& center, double radius) {
  const Vec3 m = ray.origin - center;
  return between_roots(1.0, glm::dot(m, ray.direction), glm::dot(m, m) - radius * radius);
}

/// |part of (x - base) that `project` keeps| <= radius
template <class Project>
Span around(const Ray& ray, const Vec3& base, double radius, const Project& project) {
  const Vec3 m = project(ray.origin - base);
  const Vec3 d = project(ray.direction);
  const double a = glm::dot(d, d);
  if (a < 1e-18) return glm::dot(m, m) <= radius * radius ? all() : Span{};
  return between_roots(a, glm::dot(m, d), glm::dot(m, m) - radius * radius);
}

Span upright(const Ray& ray, const Vec3& base, double radius) {
  Span span = around(ray, base, radius, [](const Vec3& x) { return Vec3(x.x, x.y, 0.0); });
  span.intersect(half_space(ray, {0, 0, -1}, -base.z));
  return span;
}

Span slab(const Ray& ray, const Vec3& normal, double low, double high) {
  Span span = half_space(ray, normal, high);
  span.intersect(half_space(ray, -normal, -low));
  return span;
}

/// Upright strip above the segment pq, `radius` thick on both sides, moved down by `lower` along
/// the normal of the segment in its upright plane.
Span strip(const Ray& ray, const Vec3& p, const Vec3& q, double radius, double lower) {
  const Vec2 level(q - p);
  const double length = glm::length(level);
  if (length < 1e-9) return {};
  const Vec3 along(level / length, 0.0);
  const Vec3 across(-along.y, along.x, 0.0);
  const Vec3 down = glm::normalize(Vec3(along.x * (q.z - p.z), along.y * (q.z - p.z), -length));
  Span span = slab(ray, across, glm::dot(across, p) - radius, glm::dot(across, p) + radius);
  span.intersect(slab(ray, along, glm::dot(along, p), glm::dot(along, q)));
  span.intersect(half_space(ray, down, glm::dot(down, p) + lower));
  return span;
}

Span tube(const Ray& ray, const Vec3& p, const Vec3& q, double radius) {
  const double length = glm::length(q - p);
  if (length < 1e-9) return {};
  const Vec3 axis = (q - p) / length;
  Span span =
      around(ray, p, radius, [&axis](const Vec3& x) { return x - glm::dot(x, axis) * axis; });
  span.intersect(slab(ray, axis, glm::dot(axis, p), glm::dot(axis, q)));
  return span;
}

/// Level discs along pq.
Span oblique(const Ray& ray, const Vec3& p, const Vec3& q, double radius) {
  const Vec3 v = q - p;
  if (std::abs(v.z) < 1e-9) return {};
  Span span = around(ray, p, radius, [&v](const Vec3& x) { return x - x.z / v.z * v; });
  span.intersect(slab(ray, {0, 0, 1}, std::min(p.z, q.z), std::max(p.z, q.z)));
  return span;
}

/// z - tip.z - height >= slope * (r - radius), slope > 0
Span cone(const Ray& ray, const Vec3& tip, const ProfilePoint& a, const ProfilePoint& b) {
  const double slope = (static_cast<double>(b.height_mm) - a.height_mm) /
                       (static_cast<double>(b.radius_mm) - a.radius_mm);
  // Apex at tip + h: (z - apex) >= slope * r.
  const Vec3 apex = tip + Vec3(0, 0, a.height_mm - slope * a.radius_mm);
  const Vec3 m = ray.origin - apex;
  const Vec3& d = ray.direction;
  const double k = slope * slope;
  const double qa = k * (d.x * d.x + d.y * d.y) - d.z * d.z;
  const double qb = k * (m.x * d.x + m.y * d.y) - m.z * d.z;
  const double qc = k * (m.x * m.x + m.y * m.y) - m.z * m.z;
  const Span above = half_space(ray, {0, 0, -1}, -apex.z);
  if (qa > 1e-12) {
    Span span = between_roots(qa, qb, qc);
    // Both roots lie in one nappe.
    const double middle = m.z + d.z * 0.5 * (span.in + span.out);
    return !span.empty() && middle > 0.0 ? span : Span{};
  }
  // The ray is steeper than the cone: one root per nappe, inside beyond that of the upper one.
  const double root = std::sqrt(std::max(0.0, qb * qb - qa * qc));
  Span span = above;
  const double roots[] = {(-qb - root) / qa, (-qb + root) / qa};
  for (const double s : roots) {
    if (m.z + d.z * s < 0.0) continue;
    span.intersect(d.z > 0.0 ? Span{s, kForever} : Span{-kForever, s});
  }
  return span;
}

/// The cutter at one place.
Span meet_outline(const Ray& ray, const Vec3& tip, const Outline& outline) {
  Span span = upright(ray, tip + Vec3(0, 0, outline.front().height_mm), outline.back().radius_mm);
  for (std::size_t i = 0; i + 1 < outline.size() && !span.empty(); ++i) {
    if (outline[i + 1].radius_mm - outline[i].radius_mm < 1e-6f) continue;
    if (outline[i + 1].height_mm - outline[i].height_mm < 1e-6f) continue;
    span.intersect(cone(ray, tip, outline[i], outline[i + 1]));
  }
  return span;
}

}  // namespace

void Span::extend(const Span& other) {
  if (other.empty()) return;
  if (empty()) *this = {};  // its ends may be the wrong way round
  in = std::min(in, other.in);
  out = std::max(out, other.out);
}

void Span::intersect(const Span& other) {
  in = std::max(in, other.in);
  out = std::min(out, other.out);
}

Span meet_box(const Ray& ray, const Box& box) {
  Span span = all();
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 normal(0.0);
    normal[axis] = 1.0;
    span.intersect(slab(ray, normal, box.min[axis], box.max[axis]));
  }
  return span;
}

Span meet_cylinder(const Ray& ray, const Vec3& base, double radius, double height) {
  Span span = upright(ray, base, radius);
  span.intersect(half_space(ray, {0, 0, 1}, base.z + height));
  return span;
}

Span meet_ball_sweep(const Ray& ray, const Vec3& p, const Vec3& q, double radius) {
  const Vec3 up(0, 0, radius);  // from tip to centre
  Span span = sphere(ray, p + up, radius);
  span.extend(sphere(ray, q + up, radius));
  span.extend(upright(ray, p + up, radius));
  span.extend(upright(ray, q + up, radius));
  span.extend(tube(ray, p + up, q + up, radius));
  span.extend(strip(ray, p + up, q + up, radius, 0.0));
  return span;
}

Span meet_flat_sweep(const Ray& ray, const Vec3& p, const Vec3& q, double radius) {
  Span span = upright(ray, p, radius);
  span.extend(upright(ray, q, radius));
  span.extend(oblique(ray, p, q, radius));
  span.extend(strip(ray, p, q, radius, 0.0));
  return span;
}

Span meet_outline_sweep(const Ray& ray, const Vec3& p, const Vec3& q, const Outline& outline) {
  // A flat cutter as wide holds it all.
  if (meet_flat_sweep(ray, p, q, outline.back().radius_mm).empty()) return {};
  constexpr int kPlaces = 24;
  const auto at = [&](double t) { return meet_outline(ray, glm::mix(p, q, t), outline); };
  Span span;
  double first = 0.0, last = 0.0;
  for (int i = 0; i <= kPlaces; ++i) {
    const double t = static_cast<double>(i) / kPlaces;
    const Span here = at(t);
    if (here.empty()) continue;
    if (here.in < span.in) first = t;
    if (here.out > span.out) last = t;
    span.extend(here);
  }
  if (span.empty()) return span;
  // Entry is convex over the move, exit concave; empty spans give +-infinity as they should.
  const auto refine = [&](double t, const auto& better) {
    double low = std::max(0.0, t - 1.0 / kPlaces), high = std::min(1.0, t + 1.0 / kPlaces);
    for (int i = 0; i < 26; ++i) {
      const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
      const Span at_a = at(a), at_b = at(b);
      span.extend(at_a);
      span.extend(at_b);
      if (at_a.empty() != at_b.empty()) {
        (at_a.empty() ? low : high) = at_a.empty() ? a : b;
      } else if (better(at_a, at_b)) {
        high = b;
      } else {
        low = a;
      }
    }
  };
  refine(first, [](const Span& a, const Span& b) { return a.in < b.in; });
  refine(last, [](const Span& a, const Span& b) { return a.out > b.out; });
  return span;
}

double nearest_left(const Span& blank, std::span<const Span> removed) {
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  constexpr double kThin_mm = 1e-9;
  if (blank.empty()) return kNothing;
  double at = blank.in;
  for (bool moved = true; moved;) {
    moved = false;
    for (const Span& span : removed) {
      if (span.in <= at + kThin_mm && span.out > at + kThin_mm) {
        at = span.out;
        moved = true;
      }
    }
  }
  return at < blank.out - kThin_mm ? at : kNothing;
}

}  // namespace kerf
