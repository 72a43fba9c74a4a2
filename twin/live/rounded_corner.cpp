#include "twin/live/rounded_corner.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "interp_bridge/motion_kinds.h"

namespace kerf {
namespace {

bool is_straight(const Motion& m) {
  return (m.kind == MotionKind::kTraverse || m.kind == MotionKind::kFeed) &&
         m.from_abc_deg == m.to_abc_deg && m.from_uvw_mm == m.to_uvw_mm;
}

/// From what is spanned by `a` and `b` beyond the origin, each at most once; not nearer than that.
double distance_from_span(const Vec3& place, const Vec3& a, const Vec3& b) {
  const double aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b);
  const double area2 = aa * bb - ab * ab;
  const double pa = glm::dot(place, a), pb = glm::dot(place, b);
  const double s = std::clamp((pa * bb - pb * ab) / area2, 0.0, 1.0);
  const double t = std::clamp((pb * aa - pa * ab) / area2, 0.0, 1.0);
  return glm::length(place - s * a - t * b);
}

/// Where two motions go on straight, or back, there is no corner. Sine of the angle.
constexpr double kLeastBend = 1e-3;

}  // namespace

RoundedCorner rounded_corner(const Motion& before, const Motion& after, const Vec3& tip_mm,
                             double off_mm, double tolerance_mm) {
  if (before.path_mode != PathMode::kContinuous || before.kind != after.kind ||
      !is_straight(before) || !is_straight(after) || before.to_mm != after.from_mm) {
    return RoundedCorner::kNone;
  }
  const Vec3& corner = before.to_mm;
  const Vec3 back = before.from_mm - corner, on = after.to_mm - corner;
  const double bend = glm::length(glm::cross(back, on));
  if (!(bend > kLeastBend * glm::length(back) * glm::length(on))) return RoundedCorner::kNone;
  if (!(distance_from_span(tip_mm - corner, back, on) <= tolerance_mm)) return RoundedCorner::kNone;
  const double most_mm = before.blend_tolerance_mm;
  if (most_mm > 0) return off_mm <= most_mm ? RoundedCorner::kRight : RoundedCorner::kNone;
  return is_traverse(before) ? RoundedCorner::kRight : RoundedCorner::kByFeeds;
}

}  // namespace kerf
