// viewer/raycast/scene_light.h - the light and colours of the window's scene, as numbers.
//
// The same as shaders/scene.frag, shaders/background.frag and the colours of scene_renderer.cpp and
// tool_store.cpp; a test compares pictures of both.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace kerf::scene_light {

inline constexpr glm::vec3 kWorkpieceColor{0.72f, 0.74f, 0.77f};
inline constexpr glm::vec3 kCutterColor{0.86f, 0.66f, 0.20f};
inline constexpr glm::vec3 kShankColor{0.62f, 0.64f, 0.68f};
inline constexpr glm::vec3 kHolderColor{0.36f, 0.38f, 0.43f};

inline constexpr glm::vec3 kKey{-0.6210f, 0.3506f, 0.7011f};  ///< towards the lamps, view space
inline constexpr glm::vec3 kFill{0.8136f, 0.2034f, 0.5447f};
inline constexpr glm::vec3 kHalfway{-0.3367f, 0.1901f, 0.9222f};

/// Unit normal and +Z of the workpiece, both in view space; result 0 .. 1 and above.
inline glm::vec3 lit(const glm::vec3& color, const glm::vec3& normal, const glm::vec3& up) {
  const float sky = 0.36f + 0.14f * glm::dot(normal, up);
  const float light = sky + 0.50f * std::max(0.0f, glm::dot(normal, kKey)) +
                      0.22f * std::max(0.0f, glm::dot(normal, kFill));
  float gleam = std::max(0.0f, glm::dot(normal, kHalfway));
  gleam *= gleam;
  gleam *= gleam;
  gleam *= gleam;
  return color * light + 0.14f * gleam * gleam;
}

/// `v`: 0 at the lower edge of the picture, 1 at the upper.
inline glm::vec3 background(float v) {
  const float share = v * v * (3.0f - 2.0f * v);
  return glm::mix(glm::vec3(0.955f, 0.960f, 0.965f), glm::vec3(0.785f, 0.815f, 0.850f), share);
}

}  // namespace kerf::scene_light
