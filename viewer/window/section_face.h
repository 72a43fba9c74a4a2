// viewer/window/section_face.h - where the section plane cuts the picture. For the sources of
// viewer/ only.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "viewer/orbit_camera.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {

/// Of the plane, as kept_side() has it: window depth at a pixel is dot(result, (x, y, 1)), x and y
/// counted from the middle of the picture, for the shader's 32-bit numbers. None where it is seen
/// from its edge, or from the side that is kept.
std::optional<glm::dvec3> section_depths(const glm::dvec4& kept, const Projection& projection);

}  // namespace kerf
