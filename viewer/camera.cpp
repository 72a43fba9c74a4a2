#include "viewer/camera.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace kerf {
namespace {

/// Room between the outermost points and the clip planes, relative to the extent along the view.
constexpr double kDepthSlack = 0.05;
constexpr double kMinExtent_mm = 1.0;  // for a single point

/// Position along one picture axis (x or y) of an eye that sees all points between the rays `low`
/// and `high` (tangents), and the smallest z that allows it. p = points (axis, z), z towards the
/// eye:
///     low <= (p.axis - eye) / (z - p.z) <= high
struct AxisFit {
  double eye_from_z(double z) const { return 0.5 * ((upper - high * z) + (lower - low * z)); }
  double nearest_z() const { return (upper - lower) / (high - low); }
  double low, high;
  double upper = -std::numeric_limits<double>::infinity();  // eye >= upper - high * z
  double lower = std::numeric_limits<double>::infinity();   // eye <= lower - low * z
  void add(double axis, double z) {
    upper = std::max(upper, axis + high * z);
    lower = std::min(lower, axis + low * z);
  }
};

}  // namespace

Camera Camera::fit(std::span<const Vec3> points_mm, const Vec3& direction, double fov_deg,
                   glm::ivec2 picture_px, const Margins& margins, const Vec3& up_mm) {
  assert(!points_mm.empty());
  const glm::dvec2 size_px(picture_px);
  const Vec3 back = glm::normalize(direction);
  const Vec3 right = glm::normalize(glm::cross(up_mm, back));
  const Vec3 up = glm::cross(back, right);

  const double tan_y = std::tan(0.5 * fov_deg * kPi / 180.0);
  const double tan_x = tan_y * size_px.x / size_px.y;
  AxisFit fit_x{tan_x * (2.0 * margins.left_px / size_px.x - 1.0),
                tan_x * (1.0 - 2.0 * margins.right_px / size_px.x)};
  AxisFit fit_y{tan_y * (2.0 * margins.bottom_px / size_px.y - 1.0),
                tan_y * (1.0 - 2.0 * margins.top_px / size_px.y)};
  double z_low = std::numeric_limits<double>::infinity();
  double z_high = -z_low;
  for (const Vec3& p : points_mm) {
    const double z = glm::dot(p, back);
    fit_x.add(glm::dot(p, right), z);
    fit_y.add(glm::dot(p, up), z);
    z_low = std::min(z_low, z);
    z_high = std::max(z_high, z);
  }
  const double slack = kDepthSlack * std::max(z_high - z_low, kMinExtent_mm);
  const double eye_z = std::max({fit_x.nearest_z(), fit_y.nearest_z(), z_high + 2.0 * slack});
  const Vec3 eye = right * fit_x.eye_from_z(eye_z) + up * fit_y.eye_from_z(eye_z) + back * eye_z;

  Camera camera;
  camera.picture_px_ = size_px;
  camera.distance_mm_ = static_cast<float>(eye_z - 0.5 * (z_low + z_high));
  glm::dmat4 view(1.0);
  for (int k = 0; k < 3; ++k) {
    view[k][0] = right[k];
    view[k][1] = up[k];
    view[k][2] = back[k];
  }
  view[3] = glm::dvec4(-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(back, eye), 1.0);
  camera.view_from_world_ = view;
  camera.up_view_ = glm::vec3(glm::dmat3(view) * up_mm);
  const double near_mm = eye_z - z_high - slack;
  const double far_mm = eye_z - z_low + slack;
  glm::dmat4 projection(0.0);
  projection[0][0] = 1.0 / tan_x;
  projection[1][1] = 1.0 / tan_y;
  projection[2][2] = -(far_mm + near_mm) / (far_mm - near_mm);
  projection[2][3] = -1.0;
  projection[3][2] = -2.0 * far_mm * near_mm / (far_mm - near_mm);
  camera.clip_from_view_ = projection;
  return camera;
}

glm::vec3 Camera::project(const Vec3& point_mm) const {
  const glm::vec4 clip = clip_from_world() * glm::vec4(glm::vec3(point_mm), 1.0f);
  const glm::vec3 ndc = glm::vec3(clip) / clip.w;
  return {(0.5f + 0.5f * ndc.x) * picture_px_.x, (0.5f - 0.5f * ndc.y) * picture_px_.y,
          0.5f + 0.5f * ndc.z};
}

glm::vec4 Camera::unproject() const {
  // ndc.z = -P22 + P32 / distance, solved for 1 / distance, with ndc.z = 2 depth - 1.
  const float p22 = clip_from_view_[2][2];
  const float p32 = clip_from_view_[3][2];
  return {1.0f / clip_from_view_[0][0], 1.0f / clip_from_view_[1][1], (-1.0f + p22) / p32,
          2.0f / p32};
}

float Camera::px_mm_at_1mm() const { return 2.0f / (clip_from_view_[1][1] * picture_px_.y); }

}  // namespace kerf
