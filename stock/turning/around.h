// stock/turning/around.h - what surfaces of revolution, whole ones and bands, have in common.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "base/geometry.h"
#include "base/portable_math.h"
#include "stock/turning/bar_flats.h"

namespace kerf::turning {

/// Directions round the axis, the first once more at the end.
inline std::vector<Vec2> directions(int segments) {
  std::vector<Vec2> all;
  for (int i = 0; i < segments; ++i) {
    const double angle = 2 * kPi * i / segments;
    all.emplace_back(portable::cos(angle), portable::sin(angle));
  }
  all.push_back(all.front());
  return all;
}

inline glm::vec3 place(const Vec2& zr, const Vec2& direction) {
  return {static_cast<float>(zr.y * direction.x), static_cast<float>(zr.y * direction.y),
          static_cast<float>(zr.x)};
}

/// How far the bar reaches along each direction; the first once more at the end.
inline std::vector<double> reaches(int segments, const BarFlats& flats) {
  std::vector<double> all;
  for (int i = 0; i <= segments; ++i) all.push_back(flats.reach_mm(2 * kPi * i / segments));
  return all;
}

/// Into how many parts of equal length an edge is divided where flats may cut off a cone: steps of
/// radius are no greater than twice the tolerance. Of a step that ends beyond a flat a quarter is
/// the most that the straight way to it is off.
inline int parts_at_flats(const Vec2& a, const Vec2& b, const BarFlats& flats,
                          double tolerance_mm) {
  constexpr double kMostParts = 256;
  const double low = std::min(a.y, b.y), high = std::max(a.y, b.y);
  if (a.x == b.x || high <= flats.inner_radius_mm || low >= flats.outer_radius_mm()) return 1;
  return static_cast<int>(
      std::clamp(std::ceil((high - low) / (2 * tolerance_mm)), 1.0, kMostParts));
}

/// The strip between two rings of corners, counter-clockwise seen from outside; a ring of one
/// corner, on the axis, has step 0.
template <class Triangle>
void add_strip(int segments, std::uint32_t from, std::uint32_t from_step, std::uint32_t to,
               std::uint32_t to_step, bool wraps, Triangle&& triangle) {
  for (int i = 0; i < segments; ++i) {
    const auto a = static_cast<std::uint32_t>(i);
    const auto b = wraps && i + 1 == segments ? 0 : a + 1;
    const std::uint32_t p = from + a * from_step, next_p = from + b * from_step;
    const std::uint32_t q = to + a * to_step, next_q = to + b * to_step;
    if (from_step != 0) triangle(p, q, next_p);
    if (to_step != 0) triangle(next_p, q, next_q);
  }
}

}  // namespace kerf::turning
