#include "twin/machine/kinematics/pose.h"

#include <cmath>

#include "base/portable_math.h"
#include "base/units.h"

namespace kerf {
namespace {

/// Sine of an angle that counts in degrees: exact at multiples of 90, where std::sin of radians is
/// not, and as exact at 36 000 degrees (a C axis that has wound up) as at 0.
double sin_deg(double degrees) {
  const double turned = std::remainder(degrees, 360.0);
  if (turned == 0.0 || std::abs(turned) == 180.0) return 0.0;
  if (std::abs(turned) == 90.0) return turned > 0 ? 1.0 : -1.0;
  return portable::sin(turned * kRadPerDeg);
}
double cos_deg(double degrees) {
  const double turned = std::abs(std::remainder(degrees, 360.0));
  if (turned == 90.0) return 0.0;
  if (turned == 180.0) return -1.0;
  return portable::cos(turned * kRadPerDeg);
}

}  // namespace

Pose turn(const Vec3& axis, double degrees) {
  const double s = sin_deg(degrees);
  const double c = cos_deg(degrees);
  const double t = 1.0 - c;
  const Vec3& a = axis;
  // Rodrigues' formula; glm's matrices are given by columns.
  return {glm::dmat3(t * a.x * a.x + c, t * a.x * a.y + s * a.z, t * a.x * a.z - s * a.y,
                     t * a.x * a.y - s * a.z, t * a.y * a.y + c, t * a.y * a.z + s * a.x,
                     t * a.x * a.z + s * a.y, t * a.y * a.z - s * a.x, t * a.z * a.z + c),
          Vec3(0.0)};
}

glm::mat4 to_mat4(const Pose& pose) {
  glm::mat4 out{glm::mat3(pose.rotation)};
  out[3] = glm::vec4(glm::vec3(pose.origin_mm), 1.0f);
  return out;
}

Box box_around(const Pose& outer_from_inner, const Box& box) {
  Box around;
  if (box.empty()) return around;
  for (int corner = 0; corner < 8; ++corner) {
    around.extend(outer_from_inner.point({(corner & 1) != 0 ? box.max.x : box.min.x,
                                          (corner & 2) != 0 ? box.max.y : box.min.y,
                                          (corner & 4) != 0 ? box.max.z : box.min.z}));
  }
  return around;
}

}  // namespace kerf
