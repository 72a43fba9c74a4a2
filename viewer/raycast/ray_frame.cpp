#include "viewer/raycast/ray_frame.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace kerf {
namespace {

/// Of the matrix, without the translation.
Vec3 row(const glm::dmat4& m, int r) { return {m[0][r], m[1][r], m[2][r]}; }

}  // namespace

RayFrame::RayFrame(const glm::mat4& clip_from_world, glm::ivec2 size_px)
    : clip_from_world_(clip_from_world),
      ndc_from_px_(2.0 / std::max(1, size_px.x), 2.0 / std::max(1, size_px.y)) {
  const glm::dmat4& m = clip_from_world_;
  clip_z_ = row(m, 2);
  clip_w_ = row(m, 3);
  is_perspective_ = clip_w_ != Vec3(0.0);
  // Three rows of the matrix tell ndc.x, ndc.y and how far along: w of a perspective view, else z.
  const int along = is_perspective_ ? 3 : 2;
  const glm::dmat3 inverse =
      glm::inverse(glm::transpose(glm::dmat3(row(m, 0), row(m, 1), row(m, along))));
  base_ = inverse * -Vec3(m[3][0], m[3][1], m[3][along]);
  right_ = inverse[0];
  up_ = inverse[1];
  forward_ = inverse[2];
}

Ray RayFrame::ray(double x_px, double y_px) const {
  const double x = x_px * ndc_from_px_.x - 1.0;
  const double y = 1.0 - y_px * ndc_from_px_.y;
  const Vec3 aside = x * right_ + y * up_;
  if (is_perspective_) return {base_, aside + forward_, 0.0};
  return {base_ + aside, forward_, -std::numeric_limits<double>::infinity()};
}

float RayFrame::depth(const Ray& ray, double t) const {
  const Vec3 point = ray.origin_mm + t * ray.direction_mm;
  const double z = glm::dot(clip_z_, point) + clip_from_world_[3][2];
  const double w = glm::dot(clip_w_, point) + clip_from_world_[3][3];
  return static_cast<float>(std::clamp(0.5 + 0.5 * z / w, 0.0, 1.0));
}

}  // namespace kerf
