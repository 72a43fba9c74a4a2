// viewer/raycast/part_light.h - the light in the picture of a finished part, as numbers: what
// shaders/composite.frag computes.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace kerf::part_light {

inline constexpr glm::vec3 kKey{-0.6210f, 0.3506f, 0.7011f};  ///< towards the lamps, view space
inline constexpr glm::vec3 kFill{0.8136f, 0.2034f, 0.5447f};
inline constexpr glm::vec3 kPanel{-0.4200f, 0.8600f, -0.2890f};
/// The room is reflected as if the eye were this much closer.
inline constexpr float kNearRoom = 2.6f;

inline float smooth_step(float low, float high, float value) {
  const float share = std::clamp((value - low) / (high - low), 0.0f, 1.0f);
  return share * share * (3.0f - 2.0f * share);
}

/// Brightness of the room in direction `way`: light ceiling, grey floor, lamps.
inline float room(const glm::vec3& way, const glm::vec3& up) {
  return 0.12f + 0.38f * smooth_step(-1.00f, 0.90f, glm::dot(way, up)) +
         0.90f * smooth_step(0.40f, 0.98f, glm::dot(way, kKey)) +
         0.35f * smooth_step(0.40f, 1.00f, glm::dot(way, kFill)) +
         0.55f * smooth_step(0.55f, 1.00f, glm::dot(way, kPanel));
}

/// Milled aluminium; all vectors of unit length in view space. `open`: 1 where nothing shades.
/// Linear light.
inline glm::vec3 lit(const glm::vec3& normal, const glm::vec3& to_eye, const glm::vec3& to_near_eye,
                     const glm::vec3& up, float open) {
  const float sky = 0.20f + 0.26f * (0.5f + 0.5f * glm::dot(normal, up));
  const float key = std::max(0.0f, glm::dot(normal, kKey));
  const float fill = std::max(0.0f, glm::dot(normal, kFill));
  const float diffuse = sky * open + (0.50f * key + 0.15f * fill) * (0.5f + 0.5f * open);
  float grazing = 1.0f - std::clamp(glm::dot(normal, to_eye), 0.0f, 1.0f);
  grazing *= grazing;
  const float mirror = room(glm::reflect(-to_near_eye, normal), up) * (0.3f + 0.7f * open);
  return glm::vec3(0.430f, 0.444f, 0.462f) * diffuse +
         glm::vec3(0.320f, 0.327f, 0.335f) * mirror * (0.85f + 0.5f * grazing * grazing);
}

}  // namespace kerf::part_light
