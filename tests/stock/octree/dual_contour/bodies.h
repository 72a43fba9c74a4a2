// tests/stock/octree/dual_contour/bodies.h - bodies with closed forms.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "tests/stock/octree/dual_contour/sampled_field.h"

namespace kerf {

inline Body sphere_body(const Vec3& center, double radius) {
  return {[=](const Vec3& p) { return glm::length(p - center) - radius; },
          [=](const Vec3& p) { return glm::normalize(p - center); }};
}

/// All points within `radius` of the line from `a` to `b`.
inline Body capsule_body(const Vec3& a, const Vec3& b, double radius) {
  const auto from_line = [=](const Vec3& p) {
    const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return p - (a + t * (b - a));
  };
  return {[=](const Vec3& p) { return glm::length(from_line(p)) - radius; },
          [=](const Vec3& p) { return glm::normalize(from_line(p)); }};
}

/// `turn` takes the box's own frame, in which it reaches from -half to half, to that of the field.
inline Body box_body(const Vec3& center, const Vec3& half, const glm::dmat3& turn = glm::dmat3(1)) {
  const auto excess = [=](const Vec3& p) {
    return glm::abs(glm::transpose(turn) * (p - center)) - half;
  };
  return {[=](const Vec3& p) {
            const Vec3 out = excess(p);
            return std::max({out.x, out.y, out.z});
          },
          [=](const Vec3& p) {
            const Vec3 out = excess(p), own = glm::transpose(turn) * (p - center);
            const int axis = out.x >= out.y && out.x >= out.z ? 0 : out.y >= out.z ? 1 : 2;
            Vec3 normal(0);
            normal[axis] = own[axis] < 0.0 ? -1.0 : 1.0;
            return turn * normal;
          }};
}

/// Material of either.
inline Body either(const Body& a, const Body& b) {
  const auto nearer = [=](const Vec3& p) { return a.distance(p) < b.distance(p); };
  return {[=](const Vec3& p) { return std::min(a.distance(p), b.distance(p)); },
          [=](const Vec3& p) { return nearer(p) ? a.normal(p) : b.normal(p); },
          [=](const Vec3& p) { return nearer(p) ? a.cut_by(p) : b.cut_by(p); }};
}

/// What is left of `a` where move `id` took `b` out.
inline Body without(const Body& a, const Body& b, std::uint32_t id = MeshPatch::kNotCut) {
  const auto is_cut = [=](const Vec3& p) { return -b.distance(p) > a.distance(p); };
  return {[=](const Vec3& p) { return std::max(a.distance(p), -b.distance(p)); },
          [=](const Vec3& p) { return is_cut(p) ? -b.normal(p) : a.normal(p); },
          [=](const Vec3& p) { return is_cut(p) ? id : a.cut_by(p); }};
}

inline glm::dmat3 turned(const Vec3& about, double angle_rad) {
  const Vec3 u = glm::normalize(about);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const auto column = [&](const Vec3& e) {
    return c * e + s * glm::cross(u, e) + (1.0 - c) * glm::dot(u, e) * u;
  };
  return {column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})};
}

}  // namespace kerf
