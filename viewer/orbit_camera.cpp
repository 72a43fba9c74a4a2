#include "viewer/orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace kerf {
namespace {

constexpr double kFieldOfView_rad = 24.0 * kPi / 180.0;
/// Straight down and straight up are allowed: right and up come from the angles, not from +Z.
constexpr double kMaxPitch_rad = 0.5 * kPi;
constexpr double kLeastExtent_mm = 1e-3;
constexpr double kMaxExtent_mm = 1e6;
constexpr double kFitMargin = 1.12;
/// Room between content and clip planes, relative to the depth of the content.
constexpr double kOrbitDepthSlack = 0.05;
/// The near plane of a perspective view stays at least this share of the distance before the eye:
/// depth has 24 bits.
constexpr double kNearestShare = 0.02;

}  // namespace

OrbitCamera::Axes OrbitCamera::axes() const {
  if (flat_ == FlatView::kXy) return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (flat_ == FlatView::kZx) return {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  const double cy = std::cos(yaw_rad_), sy = std::sin(yaw_rad_);
  const double cp = std::cos(pitch_rad_), sp = std::sin(pitch_rad_);
  return {in_workpiece({-sy, cy, 0.0}, standing_),
          in_workpiece({-sp * cy, -sp * sy, cp}, standing_),
          in_workpiece({cp * cy, cp * sy, sp}, standing_)};
}

double OrbitCamera::distance_mm() const {
  return 0.5 * extent_mm_ / std::tan(kFieldOfView_rad / 2);
}

double OrbitCamera::pixel_mm(glm::ivec2 size_px) const {
  return extent_mm_ / std::max(1, size_px.y);
}

ViewDetail OrbitCamera::detail(glm::ivec2 size_px) const {
  const double at_target = pixel_mm(size_px);
  if (!is_perspective()) return {at_target};
  const Vec3 per_mm = -at_target / distance_mm() * axes().back;
  return {at_target - glm::dot(per_mm, target_mm_), per_mm};
}

Vec3 OrbitCamera::in_target_plane(glm::vec2 px, glm::ivec2 size_px) const {
  const glm::dvec2 middle = 0.5 * glm::dvec2(size_px);
  const Axes a = axes();
  return pixel_mm(size_px) * ((static_cast<double>(px.x) - middle.x) * a.right -
                              (static_cast<double>(px.y) - middle.y) * a.up);
}

void OrbitCamera::orbit(glm::vec2 drag_px, glm::ivec2 size_px) {
  if (flat_ != FlatView::kNone) return;
  const double rad_per_px = kPi / std::max(1, size_px.y);
  yaw_rad_ = std::remainder(yaw_rad_ - static_cast<double>(drag_px.x) * rad_per_px, 2.0 * kPi);
  pitch_rad_ = std::clamp(pitch_rad_ + static_cast<double>(drag_px.y) * rad_per_px, -kMaxPitch_rad,
                          kMaxPitch_rad);
}

void OrbitCamera::pan(glm::vec2 drag_px, glm::ivec2 size_px) {
  target_mm_ -= in_target_plane(drag_px, size_px) - in_target_plane(glm::vec2(0), size_px);
}

void OrbitCamera::zoom(double factor, glm::vec2 cursor_px, glm::ivec2 size_px) {
  const Vec3 before = in_target_plane(cursor_px, size_px);
  extent_mm_ = std::clamp(extent_mm_ / factor, kLeastExtent_mm, kMaxExtent_mm);
  target_mm_ += before - in_target_plane(cursor_px, size_px);
}

void OrbitCamera::fit(const Box& box, glm::ivec2 size_px) {
  if (box.empty()) return;
  target_mm_ = 0.5 * (box.min + box.max);
  const Axes a = axes();
  const Vec3 half = 0.5 * box.size();
  const auto reach = [&half](const Vec3& axis) {
    return std::abs(axis.x) * half.x + std::abs(axis.y) * half.y + std::abs(axis.z) * half.z;
  };
  const double aspect = static_cast<double>(std::max(1, size_px.x)) / std::max(1, size_px.y);
  double extent = 2.0 * std::max(reach(a.up), reach(a.right) / aspect);
  // What is nearer than the target appears larger.
  if (is_perspective()) extent += 2.0 * reach(a.back) * std::tan(kFieldOfView_rad / 2);
  extent_mm_ = std::clamp(kFitMargin * extent, kLeastExtent_mm, kMaxExtent_mm);
}

void OrbitCamera::look_from(StandardView view) {
  if (flat_ != FlatView::kNone) return;
  constexpr double kQuarter = 0.5 * kPi;
  pitch_rad_ = 0.0;
  switch (view) {
    case StandardView::kFront:
      yaw_rad_ = -kQuarter;
      break;
    case StandardView::kBack:
      yaw_rad_ = kQuarter;
      break;
    case StandardView::kLeft:
      yaw_rad_ = 2.0 * kQuarter;
      break;
    case StandardView::kRight:
      yaw_rad_ = 0.0;
      break;
    case StandardView::kTop:
      yaw_rad_ = -kQuarter;
      pitch_rad_ = kQuarter;
      break;
    case StandardView::kBottom:
      yaw_rad_ = -kQuarter;
      pitch_rad_ = -kQuarter;
      break;
    case StandardView::kIsometric:
      yaw_rad_ = -0.5 * kQuarter;
      pitch_rad_ = std::atan(std::sqrt(0.5));
      break;
  }
}

void OrbitCamera::look_from(double yaw_rad, double pitch_rad) {
  if (flat_ != FlatView::kNone) return;
  yaw_rad_ = std::remainder(yaw_rad, 2.0 * kPi);
  pitch_rad_ = std::clamp(pitch_rad, -kMaxPitch_rad, kMaxPitch_rad);
}

Projection OrbitCamera::projection(const Box& content, glm::ivec2 size_px) const {
  const Axes a = axes();
  const Vec3 eye = target_mm_ + distance_mm() * a.back;
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = -nearest;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1u) ? content.max.x : content.min.x,
                 (corner & 2u) ? content.max.y : content.min.y,
                 (corner & 4u) ? content.max.z : content.min.z);
    const double depth = glm::dot(eye - p, a.back);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  const double slack = kOrbitDepthSlack * std::max(farthest - nearest, kLeastExtent_mm);
  double near_mm = nearest - slack;
  double far_mm = farthest + slack;
  const double aspect = static_cast<double>(std::max(1, size_px.x)) / std::max(1, size_px.y);
  glm::dmat4 clip(0.0);
  if (is_perspective()) {
    near_mm = std::max(near_mm, kNearestShare * distance_mm());
    far_mm = std::max(far_mm, 2.0 * near_mm);
    const double tan_y = std::tan(kFieldOfView_rad / 2);
    clip[0][0] = 1.0 / (tan_y * aspect);
    clip[1][1] = 1.0 / tan_y;
    clip[2][2] = -(far_mm + near_mm) / (far_mm - near_mm);
    clip[2][3] = -1.0;
    clip[3][2] = -2.0 * far_mm * near_mm / (far_mm - near_mm);
  } else {
    clip[0][0] = 2.0 / (extent_mm_ * aspect);
    clip[1][1] = 2.0 / extent_mm_;
    clip[2][2] = -2.0 / (far_mm - near_mm);
    clip[3][2] = -(far_mm + near_mm) / (far_mm - near_mm);
    clip[3][3] = 1.0;
  }
  glm::dmat4 view(1.0);
  for (int k = 0; k < 3; ++k) {
    view[k][0] = a.right[k];
    view[k][1] = a.up[k];
    view[k][2] = a.back[k];
  }
  view[3] = glm::dvec4(-glm::dot(a.right, eye), -glm::dot(a.up, eye), -glm::dot(a.back, eye), 1.0);
  return {glm::mat4(clip * view), glm::mat4(view), size_px, 1.0f, glm::vec3(up_of(standing_))};
}

std::optional<glm::vec2> picture_px(const Vec3& point_mm, const Projection& projection) {
  const glm::vec4 clip = projection.clip_from_world * glm::vec4(glm::vec3(point_mm), 1.0f);
  if (!(clip.w > 0.0f)) return std::nullopt;
  const glm::vec2 ndc = glm::vec2(clip) / clip.w;
  return glm::vec2(0.5f + 0.5f * ndc.x, 0.5f - 0.5f * ndc.y) * glm::vec2(projection.size_px);
}

}  // namespace kerf
