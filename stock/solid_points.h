// stock/solid_points.h - is a point of a workpiece material?
#pragma once

#include "base/geometry.h"

namespace kerf {

/// A model that can be asked about single points, as fine as it holds its surface.
class SolidPoints {
 public:
  virtual ~SolidPoints() = default;
  /// The point is material, and deeper than `within_mm` (a small part of a cell) inside. Of what is
  /// thinner than a cell less may be told than is there; beside what is rounded outward more, by
  /// cell^2 / 8r. Some tens of nanoseconds, some hundreds beside the surface.
  virtual bool solid_at(const Vec3& point_mm, double within_mm) const = 0;
};

}  // namespace kerf
