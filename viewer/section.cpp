#include "viewer/section.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace kerf {

std::optional<Section> usual_section(SectionKind kind, const Box& bounds_mm, Standing standing) {
  if (kind == SectionKind::kNone || bounds_mm.empty()) return std::nullopt;
  const Vec3 middle = 0.5 * (bounds_mm.min + bounds_mm.max);
  const auto beyond_middle = [&](const Vec3& side) {
    const Vec3 normal = in_workpiece(side, standing);
    return SectionPlane{normal, glm::dot(normal, middle)};
  };
  Section section{beyond_middle({0, -1, 0}), std::nullopt};
  if (kind == SectionKind::kQuarter) {
    const bool is_table = standing == Standing::kOnTable;
    section.beside = beyond_middle(is_table ? Vec3(1, 0, 0) : Vec3(0, 0, 1));
  }
  return section;
}

glm::dvec3 kept_beside(const glm::dvec4& plane, const glm::dvec4& other) {
  // The point's depth is affine in the picture, and so is what lies beside it.
  const double share = other.z / plane.z;
  return {other.x - share * plane.x, other.y - share * plane.y, other.w - share * plane.w};
}

std::optional<glm::dvec4> kept_side(const SectionPlane& plane) {
  const double length = glm::length(plane.normal);
  if (!(length > 0.0) || !std::isfinite(length) || !std::isfinite(plane.offset_mm)) {
    return std::nullopt;
  }
  return glm::dvec4(-plane.normal, plane.offset_mm) / length;
}

}  // namespace kerf
