// viewer/sight_lines.h - from the eye to the workpiece. For the sources of viewer/ only.
#pragma once

#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "viewer/mesh_rays.h"
#include "viewer/orbit_camera.h"

namespace kerf {

struct SightLine {
  Vec3 from_mm{0.0};   ///< The eye; without perspective, a point far before the box.
  Vec3 to_mm{0.0};     ///< On the box, or a little before it: what touches the box is not between.
  double share = 0.0;  ///< Of the box as it is seen; all together 1.
};

/// To the sides of a box that the eye sees; none if the box is empty or the eye is in it.
/// `reach_mm`: what is farther from the box is not asked about, without perspective.
std::vector<SightLine> sight_lines(const Box& box, const Projection& eye, double reach_mm);

/// Of the workpiece's box, as it is seen: from the first share on a body that hides it fades, at
/// the second it is as clear as it gets.
inline constexpr double kMayHide = 0.05, kHidesAll = 0.35;
inline constexpr float kClearest = 0.15f;

/// How opaque a body may be at most that stands so in the workpiece frame, for all of these lines;
/// 1: it hides little. Some ten microseconds.
float most_opacity(const MeshRays& body, const glm::mat4& pose, std::span<const SightLine> lines);

}  // namespace kerf
