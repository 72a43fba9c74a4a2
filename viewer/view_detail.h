// viewer/view_detail.h - how much of the workpiece a pixel shows, at each place.
#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/geometry.h"

namespace kerf {

/// Grows evenly with the depth below the eye; the same everywhere where parallels stay parallel.
struct ViewDetail {
  double pixel_mm = 1.0;  ///< edge of a pixel at the origin of the workpiece frame
  Vec3 per_mm{0.0};       ///< by how much it grows a mm along x, y and z

  /// 0 or less beside or behind the eye.
  double at(const Vec3& point_mm) const { return pixel_mm + glm::dot(per_mm, point_mm); }
  double smallest_in(const Box& box) const { return at(middle(box)) - reach(box); }
  double largest_in(const Box& box) const { return at(middle(box)) + reach(box); }
  /// As if pixels were larger by this factor.
  ViewDetail times(double factor) const { return {factor * pixel_mm, factor * per_mm}; }

 private:
  static Vec3 middle(const Box& box) { return 0.5 * (box.min + box.max); }
  double reach(const Box& box) const { return 0.5 * glm::dot(glm::abs(per_mm), box.size()); }
};

}  // namespace kerf
