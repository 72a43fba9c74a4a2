#include "viewer/window/section_face.h"

#include <glm/matrix.hpp>

namespace kerf {

std::optional<glm::dvec3> section_depths(const glm::dvec4& kept, const Projection& projection) {
  const glm::dvec4 plane =
      glm::transpose(glm::inverse(glm::dmat4(projection.clip_from_world))) * kept;
  // The eye is at (0, 0, -1, 0).
  if (!(plane.z > 0.0)) return std::nullopt;
  // On the plane the depth is affine in the picture.
  const glm::dvec2 half_px = 0.5 * glm::dvec2(projection.size_px);
  return glm::dvec3(-0.5 * plane.x / (plane.z * half_px.x), -0.5 * plane.y / (plane.z * half_px.y),
                    0.5 - 0.5 * plane.w / plane.z);
}

}  // namespace kerf
