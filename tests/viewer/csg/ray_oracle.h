// tests/viewer/csg/ray_oracle.h - where rays meet swept cutters, by closed forms, without any mesh.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "tests/viewer/csg/test_outlines.h"

namespace kerf {

/// Points origin + s * direction; the direction has unit length, so s is in mm.
struct Ray {
  Vec3 origin;
  Vec3 direction;
};

/// Of the parameter of a ray. Default: empty.
struct Span {
  double in = std::numeric_limits<double>::infinity();
  double out = -std::numeric_limits<double>::infinity();
  bool empty() const { return !(in < out); }
  void extend(const Span& other);  // to the convex hull of both
  void intersect(const Span& other);
};

inline constexpr double kForever = 1e6;  // mm; stands for "without end"

Span meet_box(const Ray& ray, const Box& box);
/// Cylinder along z.
Span meet_cylinder(const Ray& ray, const Vec3& base, double radius, double height);

/// Regions {z >= envelope} of cutters that move from p to q. Exact: ball and flat as unions of
/// spheres, cylinders (upright, along the move, oblique) and slabs.
Span meet_ball_sweep(const Ray& ray, const Vec3& p, const Vec3& q, double radius);
Span meet_flat_sweep(const Ray& ray, const Vec3& p, const Vec3& q, double radius);
/// Any convex outline: cones over its segments, and the tip's place that lets the ray in first and
/// out last, found by search.
Span meet_outline_sweep(const Ray& ray, const Vec3& p, const Vec3& q, const Outline& outline);

/// Nearest point of the blank that is not removed; infinity if there is none.
double nearest_left(const Span& blank, std::span<const Span> removed);

}  // namespace kerf
