// stock/octree/tool_bodies.h - a cutter as a union of convex bodies of revolution.
//
//        z                     A body is where max over its elements of value(r, z) is negative.
//        |    |  wall          Every element grows with r, so a body is convex, and its function is
//        |    |                convex, 1-Lipschitz, and the exact distance inside and wherever one
//        |   /  cone           element alone is nearest. Outside of a sharp edge it is less than
//        |__/                  the distance, never more.
//   -----+------- r   bottom
#pragma once

#include <vector>

#include "base/result.h"
#include "stock/cutter/cutter.h"

namespace kerf::octree {

/// A line of the profile, or an arc with its tangents carried on beyond its ends.
struct ToolElement {
  bool arc = false;
  /// Line: value = nr * r + nz * z - offset, where (nr, nz) is a unit vector out of the tool.
  double nr = 0, nz = 0, offset = 0;
  /// Arc about (center_r, center_z); its normals run from (n0r, n0z) to (n1r, n1z).
  double center_r = 0, center_z = 0, radius = 0;
  double n0r = 0, n0z = 0, n1r = 0, n1z = 0;
};

struct ToolBody {
  enum class Shape {
    kGeneral,
    kBall,   ///< half a sphere under an endless cylinder
    kSphere  ///< a whole one
  };
  static constexpr int kMaxElements = 9;
  Shape shape = Shape::kGeneral;
  ToolElement elements[kMaxElements];
  int count = 0;
  double radius_mm = 0;  ///< greatest distance from the axis
  double low_mm = 0;     ///< lowest point above the tip
  bool endless = true;   ///< goes on upward for ever; else it ends at top_mm
  double top_mm = 0;
};

/// Hollow (concave) arcs of a profile become lines that deviate by at most this, mm.
inline constexpr double kHollowChord_mm = 0.0005;

/// Divides the profile wherever it is not convex; each part is carried level to the axis and
/// straight up. Of a cutter that undercuts, the upper side of the head is divided in the same way,
/// each part ends each part of the lower side, and the neck goes on upward. Error if the profile
/// falls from the axis outward (hollow bottom).
Result<std::vector<ToolBody>> tool_bodies(const Cutter& cutter);

}  // namespace kerf::octree
