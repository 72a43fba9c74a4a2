// twin/machine/kinematics/pose.h - where a rigid body lies: double precision, mm.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "base/geometry.h"

namespace kerf {

/// Rotation, then shift. Named `outer_from_inner`: applied to a point of the inner frame it gives
/// the same point in the outer one. The rotation is orthonormal; nothing scales.
struct Pose {
  glm::dmat3 rotation{1.0};
  Vec3 origin_mm{0.0};

  Vec3 point(const Vec3& p) const { return rotation * p + origin_mm; }
  Vec3 direction(const Vec3& d) const { return rotation * d; }
  /// `inner_from_outer`.
  Pose inverse() const {
    const glm::dmat3 back = glm::transpose(rotation);
    return {back, -(back * origin_mm)};
  }
  friend Pose operator*(const Pose& outer, const Pose& inner) {
    return {outer.rotation * inner.rotation, outer.point(inner.origin_mm)};
  }
};

/// Right-handed turn about a unit vector through the origin. Exact at multiples of 90 degrees about
/// X, Y and Z: tables are turned so most of the time.
Pose turn(const Vec3& axis, double degrees);

inline Pose shift(const Vec3& by_mm) { return {glm::dmat3(1.0), by_mm}; }

/// For the viewer. Single precision: a machine of 10 m is drawn to a micrometre.
glm::mat4 to_mat4(const Pose& pose);

/// Box around the eight corners of `box` in the outer frame; empty for an empty one.
Box box_around(const Pose& outer_from_inner, const Box& box);

}  // namespace kerf
