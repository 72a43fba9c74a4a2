// tests/stock/sweep_oracle.h - brute force in double precision: what a sweep leaves over one point.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "stock/stock_model.h"

namespace kerf::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Height over (x, y) that one move leaves, and how close the point comes to the edge of the sweep
/// seen from above.
struct OracleHeight {
  double z = kInfinity;
  double edge_distance = kInfinity;  ///< |distance to the path - radius|, mm
};

inline Vec3 tip_at(const CutMove& m, double t) {
  if (!m.arc) return m.from_mm + t * (m.to_mm - m.from_mm);
  const Vec3 c = m.arc->center_mm, axis = m.arc->axis;
  const Vec3 from = m.from_mm - c, to = m.to_mm - c;
  const double rise0 = glm::dot(from, axis), rise1 = glm::dot(to, axis);
  const Vec3 a = from - rise0 * axis;
  const double r0 = glm::length(a), r1 = glm::length(to - rise1 * axis);
  const Vec3 u = a / r0, v = glm::cross(axis, u);
  const double angle = t * m.arc->sweep_rad;
  return c + (r0 + t * (r1 - r0)) * (std::cos(angle) * u + std::sin(angle) * v) +
         (rise0 + t * (rise1 - rise0)) * axis;
}

/// Least value of f on a..b, if it has one minimum there.
template <class F>
double golden_minimum(const F& f, double a, double b) {
  const double golden = 0.6180339887498949;
  double c = b - golden * (b - a), d = a + golden * (b - a), fc = f(c), fd = f(d);
  for (int i = 0; i < 60; ++i) {
    if (fc < fd) {
      b = d, d = c, fd = fc, c = b - golden * (b - a), fc = f(c);
    } else {
      a = c, c = d, fc = fd, d = a + golden * (b - a), fd = f(d);
    }
  }
  return std::min({fc, fd, f(a), f(b)});
}

/// Samples of the path, golden-section search around every lowest one, bisection where the rim of
/// the tool passes over the point.
inline OracleHeight sweep_height(const Cutter& cutter, const CutMove& m, double x, double y,
                                 int samples) {
  OracleHeight out;
  const double radius = cutter.radius_mm();
  const auto distance = [&](double t) {
    const Vec3 p = tip_at(m, t);
    return std::hypot(x - p.x, y - p.y);
  };
  // Beyond the rim a value that still falls toward it, so that a search finds a path that only
  // grazes the point.
  const auto height = [&](double t) {
    const double d = distance(t);
    return d <= radius ? tip_at(m, t).z + cutter.height_mm(d) : 1e9 + d;
  };
  const std::size_t n = static_cast<std::size_t>(samples);
  const auto at = [&](std::size_t i) { return static_cast<double>(i) / samples; };
  std::vector<double> d(n + 1), z(n + 1);
  double widest_step = 0;
  for (std::size_t i = 0; i <= n; ++i) {
    d[i] = distance(at(i));
    if (i > 0)
      widest_step = std::max(widest_step, glm::length(tip_at(m, at(i)) - tip_at(m, at(i - 1))));
  }
  if (*std::min_element(d.begin(), d.end()) > radius + widest_step) return out;
  for (std::size_t i = 0; i <= n; ++i) z[i] = height(at(i));
  double nearest = kInfinity, lowest = kInfinity;
  for (std::size_t i = 0; i <= n; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, n);
    if (d[i] <= d[before] && d[i] <= d[after])
      nearest = std::min(nearest, golden_minimum(distance, at(before), at(after)));
    if (z[i] <= z[before] && z[i] <= z[after])
      lowest = std::min(lowest, golden_minimum(height, at(before), at(after)));
    if (i == n || (d[i] <= radius) == (d[i + 1] <= radius)) continue;
    double in = d[i] <= radius ? at(i) : at(i + 1), beyond = d[i] <= radius ? at(i + 1) : at(i);
    for (int step = 0; step < 60; ++step) {
      const double mid = 0.5 * (in + beyond);
      (distance(mid) <= radius ? in : beyond) = mid;
    }
    lowest = std::min(lowest, height(in));
  }
  if (lowest < 1e8) out.z = lowest;
  out.edge_distance = std::abs(nearest - radius);
  return out;
}

}  // namespace kerf::test
