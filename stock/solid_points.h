// stock/solid_points.h - is a point of a workpiece material?
#pragma once

#include "base/geometry.h"

namespace kerf {

/// A model that can be asked about single points, as fine as it holds its surface.
class SolidPoints {
 public:
  virtual ~SolidPoints() = default;
  /// The point is material, and deeper than `within_mm` (a small part of a cell) inside. Of what is
  /// thinner than a cell, and at edges within one, less may be told than is there, never more. Some
  /// tens of nanoseconds, some hundreds beside the surface.
  virtual bool solid_at(const Vec3& point_mm, double within_mm) const = 0;
};

}  // namespace kerf
