#include "viewer/window/screen_rect.h"

#include <algorithm>
#include <cmath>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <limits>

namespace kerf {
namespace {

/// Around projected corners: rounding of the rasterizer, and the width of a fine line.
constexpr int kBorder_px = 2;
/// Below this w a corner counts as reaching the eye.
constexpr float kMinW = 1e-4f;
/// Keeps far corners within int.
constexpr float kFarthest_px = 1e6f;

glm::vec3 corner_of(const Box& box, unsigned corner) {
  return {static_cast<float>((corner & 1u) ? box.max.x : box.min.x),
          static_cast<float>((corner & 2u) ? box.max.y : box.min.y),
          static_cast<float>((corner & 4u) ? box.max.z : box.min.z)};
}

glm::dmat4 clip_from_view(const Projection& projection) {
  return glm::dmat4(projection.clip_from_world) *
         glm::inverse(glm::dmat4(projection.view_from_world));
}

/// Edge of a pixel where the w of clip coordinates is 1.
double pixel_mm_at_w1(const Projection& projection, const glm::dmat4& clip_from_view) {
  return 2.0 / (clip_from_view[1][1] * std::max(1, projection.size_px.y));
}

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

ScreenRect ScreenRect::common(const ScreenRect& other) const {
  return {{std::max(min.x, other.min.x), std::max(min.y, other.min.y)},
          {std::min(max.x, other.max.x), std::min(max.y, other.max.y)}};
}

void add_apart(ScreenRect rect, std::vector<ScreenRect>* rects, std::int64_t spare_px) {
  if (rect.empty()) return;
  const auto joins = [&](const ScreenRect& other) {
    if (rect.intersects(other)) return true;
    ScreenRect both = rect;
    both.extend(other);
    return both.pixels() - rect.pixels() - other.pixels() < spare_px;
  };
  // What has grown may join others.
  for (auto found = std::find_if(rects->begin(), rects->end(), joins); found != rects->end();
       found = std::find_if(rects->begin(), rects->end(), joins)) {
    rect.extend(*found);
    rects->erase(found);
  }
  rects->push_back(rect);
}

ScreenRect covered_rect(const Box& box, const Projection& projection) {
  if (box.empty()) return {};
  glm::vec2 low(kFarthest_px);
  glm::vec2 high(-kFarthest_px);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::vec4 clip = projection.clip_from_world * glm::vec4(corner_of(box, corner), 1.0f);
    if (!(clip.w > kMinW)) return ScreenRect::whole(projection.size_px);
    const glm::vec2 at = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(projection.size_px);
    low = {std::min(low.x, at.x), std::min(low.y, at.y)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y)};
  }
  // What a wider line has more on each side.
  const int border_px =
      kBorder_px + static_cast<int>(std::ceil(0.5f * (projection.line_px - 1.0f)));
  const auto inside = [](float value, int offset, int limit) {
    const float kept = std::clamp(std::floor(value), -kFarthest_px, kFarthest_px);
    return std::clamp(static_cast<int>(kept) + offset, 0, limit);
  };
  return {{inside(low.x, -border_px, projection.size_px.x),
           inside(low.y, -border_px, projection.size_px.y)},
          {inside(high.x, border_px + 1, projection.size_px.x),
           inside(high.y, border_px + 1, projection.size_px.y)}};
}

Box placed(const Box& box, const glm::mat4& pose) {
  Box result;
  if (box.empty()) return result;
  for (unsigned corner = 0; corner < 8; ++corner) {
    result.extend(Vec3(pose * glm::vec4(corner_of(box, corner), 1.0f)));
  }
  return result;
}

double smallest_pixel_mm(const Box& box, const Projection& projection) {
  if (box.empty()) return 0.0;
  float nearest_w = std::numeric_limits<float>::infinity();
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::vec4 clip = projection.clip_from_world * glm::vec4(corner_of(box, corner), 1.0f);
    nearest_w = std::min(nearest_w, clip.w);
  }
  if (!(nearest_w > kMinW)) return 0.0;
  return static_cast<double>(nearest_w) * pixel_mm_at_w1(projection, clip_from_view(projection));
}

float towards_eye(const Projection& projection, double nearer_px) {
  const glm::dmat4 clip = clip_from_view(projection);
  // z / w is a + b / w in perspective and a + b w' in parallel views, w' being the distance: what a
  // pixel's edge, which grows with w, makes of it is the same everywhere once multiplied by w.
  const double per_mm = std::abs(clip[2][3]) > 0.5 ? -clip[3][2] : -clip[2][2];
  return static_cast<float>(nearer_px * pixel_mm_at_w1(projection, clip) * per_mm);
}

}  // namespace kerf
