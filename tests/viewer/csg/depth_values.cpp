#include "tests/viewer/csg/depth_values.h"

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace kerf {
namespace {

Vec3 unprojected(const glm::dmat4& world_from_clip, glm::ivec2 px, glm::ivec2 size_px,
                 double depth) {
  const glm::dvec2 uv((px.x + 0.5) / size_px.x, 1.0 - (px.y + 0.5) / size_px.y);
  const glm::dvec4 world = world_from_clip * glm::dvec4(2.0 * uv - 1.0, 2.0 * depth - 1.0, 1.0);
  return Vec3(world) / world.w;
}

glm::dmat4 inverse_of(const Projection& projection) {
  return glm::inverse(glm::dmat4(projection.clip_from_world));
}

/// `value_of` makes a number of a point of the surface.
template <class ValueOf>
std::vector<float> per_pixel(const DepthPicture& picture, const Projection& projection,
                             const ValueOf& value_of) {
  const glm::dmat4 world_from_clip = inverse_of(projection);
  const glm::ivec2 size_px(picture.width_px, picture.height_px);
  std::vector<float> values(picture.depths.size(), kNoDepth_mm);
  std::size_t i = 0;
  for (int y = 0; y < size_px.y; ++y) {
    for (int x = 0; x < size_px.x; ++x, ++i) {
      const auto depth = static_cast<double>(picture.depths[i]);
      if (depth >= 1.0) continue;
      values[i] =
          static_cast<float>(value_of(unprojected(world_from_clip, {x, y}, size_px, depth)));
    }
  }
  return values;
}

}  // namespace

std::vector<float> view_distances_mm(const DepthPicture& picture, const Projection& projection) {
  const glm::dmat4 view(projection.view_from_world);
  return per_pixel(picture, projection,
                   [&view](const Vec3& p) { return -(view * glm::dvec4(p, 1.0)).z; });
}

std::vector<float> world_heights_mm(const DepthPicture& picture, const Projection& projection) {
  return per_pixel(picture, projection, [](const Vec3& p) { return p.z; });
}

PixelRay pixel_ray(glm::ivec2 px, const Projection& projection) {
  const glm::dmat4 world_from_clip = inverse_of(projection);
  return {unprojected(world_from_clip, px, projection.size_px, 0.0),
          unprojected(world_from_clip, px, projection.size_px, 1.0)};
}

}  // namespace kerf
