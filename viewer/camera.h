// viewer/camera.h - where the picture is taken from.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "base/geometry.h"
#include "viewer/standing.h"

namespace kerf {

/// Free border around the fitted points, pixels.
struct Margins {
  float left_px = 0;
  float right_px = 0;
  float top_px = 0;
  float bottom_px = 0;
};

/// A perspective view. View space: x right, y up, looking along -z, mm. Window depth runs from 0
/// (near) to 1 (far) and is affine in 1 / distance, hence affine in the picture on every plane.
class Camera {
 public:
  /// Looks along `-direction` (from the scene to the eye, need not be of unit length, not along
  /// `up`), from as near as keeps all points inside the margins. At least one point; fov_deg is the
  /// vertical field of view; `up` is one of the axes.
  static Camera fit(std::span<const Vec3> points_mm, const Vec3& direction, double fov_deg,
                    glm::ivec2 picture_px, const Margins& margins, const Vec3& up = {0, 0, 1});

  const glm::mat4& view_from_world() const { return view_from_world_; }
  const glm::mat4& clip_from_view() const { return clip_from_view_; }
  glm::mat4 clip_from_world() const { return clip_from_view_ * view_from_world_; }

  /// Pixels from the upper left corner (y down), and the window depth.
  glm::vec3 project(const Vec3& point_mm) const;

  /// For shaders: view.xy = (2 uv - 1) * (x, y) * distance, and distance = 1 / (z + w * depth).
  glm::vec4 unproject() const;

  /// Edge of one pixel of the picture, seen from 1 mm away.
  float px_mm_at_1mm() const;

  /// `up` of fit(), in view space.
  glm::vec3 up_view() const { return up_view_; }

  /// Mean distance of the fitted points from the eye, along the view direction.
  float distance_mm() const { return distance_mm_; }

 private:
  glm::mat4 view_from_world_{1.0f};
  glm::mat4 clip_from_view_{1.0f};
  glm::vec2 picture_px_{1.0f};
  float distance_mm_ = 1.0f;
  glm::vec3 up_view_{0.0f, 0.0f, 1.0f};
};

}  // namespace kerf
