#include "viewer/window/screen_rect.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>

namespace kerf {
namespace {

/// Around projected corners: rounding of the rasterizer, and the width of a line.
constexpr int kBorder_px = 2;
/// Below this w a corner counts as reaching the eye.
constexpr float kMinW = 1e-4f;
/// Keeps far corners within int.
constexpr float kFarthest_px = 1e6f;

}  // namespace

std::int64_t ScreenRect::pixels() const {
  return empty() ? 0 : static_cast<std::int64_t>(max.x - min.x) * (max.y - min.y);
}

void ScreenRect::extend(const ScreenRect& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  min = {std::min(min.x, other.min.x), std::min(min.y, other.min.y)};
  max = {std::max(max.x, other.max.x), std::max(max.y, other.max.y)};
}

bool ScreenRect::intersects(const ScreenRect& other) const {
  return !empty() && !other.empty() && min.x < other.max.x && other.min.x < max.x &&
         min.y < other.max.y && other.min.y < max.y;
}

ScreenRect covered_rect(const Box& box, const Projection& projection) {
  if (box.empty()) return {};
  glm::vec2 low(kFarthest_px);
  glm::vec2 high(-kFarthest_px);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(static_cast<float>((corner & 1u) ? box.max.x : box.min.x),
                      static_cast<float>((corner & 2u) ? box.max.y : box.min.y),
                      static_cast<float>((corner & 4u) ? box.max.z : box.min.z));
    const glm::vec4 clip = projection.clip_from_world * glm::vec4(p, 1.0f);
    if (!(clip.w > kMinW)) return ScreenRect::whole(projection.size_px);
    const glm::vec2 at = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(projection.size_px);
    low = {std::min(low.x, at.x), std::min(low.y, at.y)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y)};
  }
  const auto inside = [](float value, int offset, int limit) {
    const float kept = std::clamp(std::floor(value), -kFarthest_px, kFarthest_px);
    return std::clamp(static_cast<int>(kept) + offset, 0, limit);
  };
  return {{inside(low.x, -kBorder_px, projection.size_px.x),
           inside(low.y, -kBorder_px, projection.size_px.y)},
          {inside(high.x, kBorder_px + 1, projection.size_px.x),
           inside(high.y, kBorder_px + 1, projection.size_px.y)}};
}

}  // namespace kerf
