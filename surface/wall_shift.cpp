#include "surface/wall_shift.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// Fewer edges than this tell no course.
constexpr int kLeastEdges = 3;
/// Edges on either side of the corner below which a parabola would follow their steps.
constexpr int kLeastForParabola = 4;
/// Sine between two walls, or a wall and the grid's border, below which where they meet is not
/// told.
constexpr float kLeastSine = 0.3f;
/// Of a cell; a triangle with less (seen from above) is avoided, if the other diagonal has more.
constexpr float kLeastArea = 0.1f;

float cross(const glm::vec2& a, const glm::vec2& b) { return a.x * b.y - a.y * b.x; }

glm::vec2 limited(const glm::vec2& shift) {
  const float most = std::max(std::abs(shift.x), std::abs(shift.y));
  return most > WallShift::kMost ? WallShift::kMost / most * shift : shift;
}

}  // namespace

/// Square of the cosine, with its sign, between the ways before and after a place; 1 where there is
/// no telling.
float WallShift::straightness(int place) const {
  const int before = std::min(kChord, place - first_), after = std::min(kChord, last_ - place);
  if (std::min(before, after) == 0) return 1;
  const glm::ivec2 a = corner(place) - corner(place - before);
  const glm::ivec2 b = corner(place + after) - corner(place);
  const int dot = a.x * b.x + a.y * b.y;
  const int squares = (a.x * a.x + a.y * a.y) * (b.x * b.x + b.y * b.y);
  if (squares == 0) return -1;
  // At an end of what is known a straight run that turns may be a corner; others may go on anyhow.
  if (std::min(before, after) == 1) return dot == 0 && std::max(before, after) >= 3 ? 0 : 1;
  return static_cast<float>(dot * std::abs(dot)) / static_cast<float>(squares);
}

/// The sharpest turn of those that are sharp, of two alike the first one; but all where the line
/// goes back, as at the end of a slot one cell wide.
bool WallShift::is_corner(int place) const {
  const auto turns_at = [this](int k) { return turns_between(k - 1, k + 1) != 0; };
  if (!turns_at(place)) return false;
  const float here = straightness(place);
  if (here >= kSharp * kSharp) return false;
  if (here < 0) return true;
  for (int k = std::max(first_ + 1, place - 3); k <= std::min(last_ - 1, place + 3); ++k) {
    if (!turns_at(k)) continue;
    const float there = straightness(k);
    if (there < here || (there == here && k < place)) return false;
  }
  return true;
}

/// The course of the edges from place `first` to place `last`: at right angles to the ways against
/// their number, by least squares; and how far from the corner.
WallShift::Course WallShift::fit(int first, int last) const {
  const int edges = last - first;
  if (edges < kLeastEdges) return {};
  if (turns_between(first, last) == 0) {
    const glm::vec2 way = glm::vec2(corner(last) - corner(first)) / static_cast<float>(edges);
    const glm::vec2 normal(-way.y, way.x);
    return {normal, glm::dot(normal, glm::vec2(corner(first) - corner(center_)))};
  }
  glm::ivec2 sum(0), moment(0);
  for (int k = first; k <= last; ++k) {
    const glm::ivec2 at = corner(k) - corner(center_);
    sum += at;
    moment += (k - first) * at;
  }
  const auto way = glm::vec2(2 * moment - edges * sum);
  const float length = glm::length(way);
  if (!(length > 0)) return {};
  const glm::vec2 along = way / length, normal(-along.y, along.x);
  // Sums of s^n and t s^n over the edges' middles, s along the way and t across it.
  std::array<float, 5> s_sum{};
  std::array<float, 3> t_sum{};
  for (int k = first; k < last; ++k) {
    const glm::vec2 middle = 0.5f * glm::vec2(corner(k) + corner(k + 1) - 2 * corner(center_));
    const float s = glm::dot(along, middle), t = glm::dot(normal, middle), s2 = s * s;
    s_sum[0] += 1;
    s_sum[1] += s;
    s_sum[2] += s2;
    s_sum[3] += s2 * s;
    s_sum[4] += s2 * s2;
    t_sum[0] += t;
    t_sum[1] += t * s;
    t_sum[2] += t * s2;
  }
  const auto [n, s1, s2, s3, s4] = s_sum;
  if (std::min(center_ - first, last - center_) < kLeastForParabola)
    return {normal, (t_sum[0] * s2 - t_sum[1] * s1) / (n * s2 - s1 * s1)};
  const float a = s2 * s4 - s3 * s3, b = s1 * s4 - s2 * s3, c = s1 * s3 - s2 * s2;
  return {normal, (t_sum[0] * a - t_sum[1] * b + t_sum[2] * c) / (n * a - s1 * b + s2 * c)};
}

glm::vec2 WallShift::shift(const glm::vec2& free) const {
  if (turns_between(first_, last_) == 0) return glm::vec2(0);
  if (is_corner(center_)) {
    int before = center_ - 1, after = center_ + 1;
    while (before > first_ && !is_corner(before)) --before;
    while (after < last_ && !is_corner(after)) ++after;
    const Course back = fit(before, center_), front = fit(center_, after);
    const float sine = cross(back.normal, front.normal);
    if (free != glm::vec2(1) || std::abs(sine) < kLeastSine) return glm::vec2(0);
    return limited(glm::vec2(back.distance * front.normal.y - front.distance * back.normal.y,
                             front.distance * back.normal.x - back.distance * front.normal.x) /
                   sine);
  }
  int before = center_, after = center_;
  while (before > first_ && (before == center_ || !is_corner(before))) --before;
  while (after < last_ && (after == center_ || !is_corner(after))) ++after;
  const Course course = fit(before, after);
  if (free == glm::vec2(1)) return limited(course.distance * course.normal);
  // To where the wall leaves the grid.
  const float sine = glm::dot(course.normal, free);
  if (std::abs(sine) < kLeastSine) return glm::vec2(0);
  return limited(course.distance / sine * free);
}

bool has_rising_diagonal(const std::array<float, 4>& z, float twice,
                         const std::array<glm::vec2, 4>& shift) {
  const glm::vec2 a = shift[0], b = shift[1] + glm::vec2(1, 0);
  const glm::vec2 c = shift[2] + glm::vec2(1, 1), d = shift[3] + glm::vec2(0, 1);
  const float rising = std::min(cross(b - a, c - a), cross(c - a, d - a));
  const float falling = std::min(cross(b - a, d - a), cross(c - b, d - b));
  if (std::min(rising, falling) >= kLeastArea) return has_rising_diagonal(z, twice);
  return rising > falling;
}

}  // namespace kerf
