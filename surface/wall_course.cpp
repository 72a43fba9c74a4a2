#include "surface/wall_course.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace kerf {

/// `sign` is 1 ahead and -1 behind. In whole numbers, so that it does not depend on where the line
/// lies.
WallCourse::Half WallCourse::half(int center, int sign, int steps) const {
  Half half{steps};
  const glm::ivec2 origin = corner(center);
  for (int k = 1; k <= steps; ++k) {
    const glm::ivec2 way = sign * (corner(center + sign * k) - origin);
    half.sum += way;
    half.moment += k * way;
  }
  return half;
}

bool WallCourse::is_sharp(const Half& behind, const Half& ahead) {
  if (std::min(behind.steps, ahead.steps) < 2) return false;
  const auto a = glm::vec2(behind.course()), b = glm::vec2(ahead.course());
  const float cosine = glm::dot(a, b);
  return cosine < 0 || cosine * cosine < kSharp * kSharp * glm::dot(a, a) * glm::dot(b, b);
}

glm::vec2 WallCourse::facing(bool at_higher_end, const glm::vec2& outward) const {
  const bool edge_is_behind = at_higher_end == starts_low_;
  const int center = kMaxReach + edge_is_behind;
  int behind = std::min(reach_, behind_ + edge_is_behind);
  int ahead = std::min(reach_, ahead_ + !edge_is_behind);
  // Up to the corners: turns that have none beside them. A run that ends with the window may be
  // long.
  unsigned turns = turns_between(center - behind, center + ahead);
  static_assert(kLongRun == 3);
  const unsigned corners = turns & ~(turns << 1 | turns << 2 | turns >> 1 | turns >> 2);
  if (corners != 0) {
    if (const unsigned before = corners & ((1u << center) - 1); before != 0)
      behind = center + 1 - std::bit_width(before);
    if (const unsigned after = corners >> center >> 1; after != 0)
      ahead = std::countr_zero(after) + 1;
    if ((corners >> center & 1u) != 0) (edge_is_behind ? ahead : behind) = 0;
    turns = turns_between(center - behind, center + ahead);
  }
  if (turns == 0) return outward;

  Half back = half(center, -1, behind), front = half(center, 1, ahead);
  if (is_sharp(back, front)) {
    back = half(center, -1, std::min(behind, kShortReach));
    front = half(center, 1, std::min(ahead, kShortReach));
    if (is_sharp(back, front)) (edge_is_behind ? front : back) = {0};
  }
  // As Half::course(), of both together.
  const glm::vec2 way(2 * (back.moment + front.moment) +
                      (back.steps - front.steps) * (front.sum - back.sum));
  const glm::vec2 to_low(way.y, -way.x);
  if (!(glm::dot(to_low, outward) > 0)) return outward;
  return to_low / std::sqrt(glm::dot(to_low, to_low));
}

}  // namespace kerf
