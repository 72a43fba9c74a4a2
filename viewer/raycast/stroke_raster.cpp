#include "viewer/raycast/stroke_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// Lets the outline of the blank win over faces of the part that lie in it. A share of the depth
/// range of the scene.
constexpr float kDepthBias = 0.004f;

/// Share of the neighbourhood that leaves the stroke visible: a soft version of the depth test.
float visible_share(std::span<const float> depths, int width, int height, int x, int y,
                    float depth) {
  if (depth < 0) return 1.0f;
  constexpr std::array<glm::ivec2, 5> kNear{{glm::ivec2(0, 0), {1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  float sum = 0;
  for (const glm::ivec2& by : kNear) {
    const int at_x = std::clamp(x + by.x, 0, width - 1), at_y = std::clamp(y + by.y, 0, height - 1);
    const float part = depths[static_cast<std::size_t>(at_y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(at_x)];
    sum += depth <= part + kDepthBias ? 0.2f : 0.0f;
  }
  return sum;
}

void draw_stroke(const Stroke& stroke, std::span<const float> depths, Picture* picture) {
  const glm::vec2 along = stroke.to_px - stroke.from_px;
  const float length = glm::length(along);
  const glm::vec2 way = length > 0 ? along / length : glm::vec2(1, 0);
  // Strokes thinner than a pixel are drawn one pixel wide and paler.
  const float half = 0.5f * std::max(stroke.width_px, 1.0f), reach = half + 1.0f;
  const float strength = stroke.rgba.a * std::min(stroke.width_px, 1.0f);
  const auto bound = [](float px, int limit) {
    return static_cast<int>(std::clamp(px, 0.0f, static_cast<float>(limit)));
  };
  const glm::vec2 low = glm::min(stroke.from_px, stroke.to_px) - reach;
  const glm::vec2 high = glm::max(stroke.from_px, stroke.to_px) + reach;
  for (int y = bound(low.y, picture->height_px); y < bound(high.y + 1, picture->height_px); ++y) {
    for (int x = bound(low.x, picture->width_px); x < bound(high.x + 1, picture->width_px); ++x) {
      const glm::vec2 arm =
          glm::vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) - stroke.from_px;
      const float position = glm::dot(arm, way);
      const float across = way.x * arm.y - way.y * arm.x;
      const float past = position - std::clamp(position, 0.0f, length);
      const float cover = std::clamp(half + 0.5f - std::hypot(past, across), 0.0f, 1.0f);
      if (cover <= 0) continue;
      const float share = length > 0 ? std::clamp(position / length, 0.0f, 1.0f) : 0.0f;
      const float depth = stroke.from_depth + share * (stroke.to_depth - stroke.from_depth);
      const float seen = visible_share(depths, picture->width_px, picture->height_px, x, y, depth);
      const float alpha =
          strength * cover * (stroke.hidden_alpha + seen * (1 - stroke.hidden_alpha));
      std::uint8_t* const rgb = &picture->rgb[3 * (static_cast<std::size_t>(y) *
                                                       static_cast<std::size_t>(picture->width_px) +
                                                   static_cast<std::size_t>(x))];
      for (int k = 0; k < 3; ++k) {
        const float mixed =
            static_cast<float>(rgb[k]) * (1 - alpha) + 255.0f * stroke.rgba[k] * alpha;
        rgb[k] = static_cast<std::uint8_t>(std::clamp(mixed, 0.0f, 255.0f) + 0.5f);
      }
    }
  }
}

}  // namespace

void draw_strokes(std::span<const Stroke> strokes, std::span<const float> depths,
                  Picture* picture) {
  for (const Stroke& stroke : strokes) draw_stroke(stroke, depths, picture);
}

}  // namespace kerf
