// tests/stock/sweep_oracle.h - brute force in double precision: what a sweep leaves over one point.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "stock/stock_model.h"

namespace kerf::test {

/// Height over (x, y) that one move leaves, and how close the point comes to the edge of the sweep
/// seen from above.
struct OracleHeight {
  double z = std::numeric_limits<double>::infinity();
  double edge_distance =
      std::numeric_limits<double>::infinity();  ///< |distance to the path - radius|, mm
};

inline Vec3 tip_at(const CutMove& m, double t) {
  if (!m.arc) return m.from_mm + t * (m.to_mm - m.from_mm);
  const Vec3 c = m.arc->center_mm, axis = m.arc->axis;
  const auto dot = [](const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
  const auto cross = [](const Vec3& a, const Vec3& b) {
    return Vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  };
  const Vec3 from = m.from_mm - c, to = m.to_mm - c;
  const double rise0 = dot(from, axis), rise1 = dot(to, axis);
  const Vec3 a = from - rise0 * axis;
  const double r0 = std::sqrt(dot(a, a)), r1 = std::sqrt(dot(to - rise1 * axis, to - rise1 * axis));
  const Vec3 u = a / r0, v = cross(axis, u);
  const double angle = t * m.arc->sweep_rad;
  return c + (r0 + t * (r1 - r0)) * (std::cos(angle) * u + std::sin(angle) * v) +
         (rise0 + t * (rise1 - rise0)) * axis;
}

/// Dense samples, then golden-section search around the best few.
inline OracleHeight sweep_height(const Cutter& cutter, const CutMove& m, double x, double y,
                                 int samples = 400) {
  OracleHeight out;
  const double radius = cutter.radius_mm();
  const auto distance = [&](double t) {
    const Vec3 p = tip_at(m, t);
    return std::hypot(x - p.x, y - p.y);
  };
  const auto height = [&](double t) {
    const double d = distance(t);
    return d <= radius ? tip_at(m, t).z + cutter.height_mm(d)
                       : std::numeric_limits<double>::infinity();
  };
  const auto refine = [](const auto& f, double a, double b) {
    const double golden = 0.6180339887498949;
    double c = b - golden * (b - a), d = a + golden * (b - a), fc = f(c), fd = f(d);
    for (int i = 0; i < 80; ++i) {
      if (fc < fd) {
        b = d, d = c, fd = fc, c = b - golden * (b - a), fc = f(c);
      } else {
        a = c, c = d, fc = fd, d = a + golden * (b - a), fd = f(d);
      }
    }
    return std::min({fc, fd, f(a), f(b)});
  };
  std::vector<double> z(static_cast<std::size_t>(samples) + 1), d(z.size());
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double t = static_cast<double>(i) / samples;
    z[i] = height(t);
    d[i] = distance(t);
  }
  const auto at = [&](std::size_t i) { return static_cast<double>(i) / samples; };
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < z.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = i + 1 < z.size() ? i + 1 : i;
    if (d[i] <= d[before] && d[i] <= d[after])
      nearest = std::min(nearest, refine(distance, at(before), at(after)));
    out.z = std::min(out.z, z[i]);
    if (z[i] <= z[before] && z[i] <= z[after] && std::isfinite(z[i]))
      out.z = std::min(out.z, refine(height, at(before), at(after)));
    // The lowest point may lie where the rim passes over the point: find that crossing.
    for (const std::size_t j : {before, after}) {
      if ((d[i] <= radius) == (d[j] <= radius)) continue;
      double in = d[i] <= radius ? at(i) : at(j), outside = d[i] <= radius ? at(j) : at(i);
      for (int step = 0; step < 60; ++step) {
        const double mid = 0.5 * (in + outside);
        (distance(mid) <= radius ? in : outside) = mid;
      }
      out.z = std::min(out.z, height(in));
    }
  }
  // A path that only grazes the point between two samples.
  for (std::size_t i = 0; i + 1 < z.size(); ++i)
    if (d[i] > radius && d[i + 1] > radius && nearest <= radius &&
        std::min(d[i], d[i + 1]) < radius + 0.5)
      out.z = std::min(
          out.z,
          refine([&](double t) { return distance(t) <= radius ? height(t) : 1e9 + distance(t); },
                 at(i), at(i + 1)) < 1e8
              ? refine(
                    [&](double t) { return distance(t) <= radius ? height(t) : 1e9 + distance(t); },
                    at(i), at(i + 1))
              : out.z);
  out.edge_distance = std::abs(nearest - radius);
  return out;
}

}  // namespace kerf::test
