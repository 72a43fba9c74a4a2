// viewer/window/sight_lines.h - from the eye to the workpiece. For the sources of viewer/ only.
#pragma once

#include <vector>

#include "base/geometry.h"
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

}  // namespace kerf
