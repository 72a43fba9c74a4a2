// tests/viewer/csg/depth_values.h - what the depths of a picture say in mm.
#pragma once

#include <limits>
#include <vector>

#include "base/geometry.h"
#include "viewer/csg/depth_picture.h"
#include "viewer/orbit_camera.h"

namespace kerf {

/// What the functions below give where there is nothing.
inline constexpr float kNoDepth_mm = std::numeric_limits<float>::infinity();

/// Per pixel, rows from the top: distance from the plane of the eye, along the view direction. For
/// an orthographic view from the plane that its matrix has as z = 0.
std::vector<float> view_distances_mm(const DepthPicture& picture, const Projection& projection);

/// Per pixel, rows from the top: z in the workpiece frame.
std::vector<float> world_heights_mm(const DepthPicture& picture, const Projection& projection);

/// Ends of the ray through the centre of a pixel (from the upper left), at depths 0 and 1.
struct PixelRay {
  Vec3 near_mm{0.0};
  Vec3 far_mm{0.0};
};
PixelRay pixel_ray(glm::ivec2 px, const Projection& projection);

}  // namespace kerf
