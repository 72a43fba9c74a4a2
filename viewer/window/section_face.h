// viewer/window/section_face.h - where the section plane cuts the picture. For the sources of
// viewer/ only.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "viewer/orbit_camera.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {

/// The plane in the frame of the workpiece, of unit normal: dot(plane, (p, 1)) >= 0 is kept. None
/// where there is no direction.
std::optional<glm::dvec4> kept_side(const std::optional<SectionPlane>& section);

/// Of the plane, as kept_side() has it: window depth at a pixel is dot(result, (x, y, 1)), x and y
/// counted from the middle of the picture, for the shader's 32-bit numbers. None where it is seen
/// from its edge.
std::optional<glm::dvec3> section_depths(const glm::dvec4& kept, const Projection& projection);

}  // namespace kerf
