#include "twin/machine/kinematics/arc_bounds.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kerf {

ArcBounds arc_bounds(const Motion& m) {
  const Vec3 d0 = m.from_mm - m.arc.center_mm;
  const Vec3 d1 = m.to_mm - m.arc.center_mm;
  const double along0 = glm::dot(d0, m.arc.axis);
  const double along1 = glm::dot(d1, m.arc.axis);
  const double r0 = glm::length(d0 - along0 * m.arc.axis);
  const double r1 = glm::length(d1 - along1 * m.arc.axis);
  const double radius = std::max(r0, r1);
  const double growth = std::abs(r1 - r0);
  const double sweep = std::abs(m.arc.sweep_rad);
  return {radius * sweep + growth + std::abs(along1 - along0),
          radius * sweep * sweep + 2 * growth * sweep,
          radius * sweep * sweep * sweep + 3 * growth * sweep * sweep};
}

bool is_arc(const Motion& m) { return m.kind == MotionKind::kArc && m.arc.sweep_rad != 0; }

}  // namespace kerf
