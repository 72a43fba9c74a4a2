// viewer/raycast/ray_frame.h - the ray of each pixel of a view, and the depth along it.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/geometry.h"

namespace kerf {

/// Points origin_mm + t * direction_mm for t >= t_min; along all rays of a view t grows away from
/// the eye. The direction is not of unit length.
struct Ray {
  Vec3 origin_mm{0.0};
  Vec3 direction_mm{0.0, 0.0, -1.0};
  double t_min = 0.0;
};

/// Takes the projection of an OpenGL view apart. A ray begins at the eye (perspective: t is the
/// distance along the view direction) or infinitely far before the scene (orthographic), not at
/// the near plane: the mesh clamps depth instead of cutting there, too.
class RayFrame {
 public:
  RayFrame(const glm::mat4& clip_from_world, glm::ivec2 size_px);

  /// Through a point of the picture, pixels from the upper left corner: the middle of pixel (x, y)
  /// is (x + 0.5, y + 0.5).
  Ray ray(double x_px, double y_px) const;
  /// Window depth, 0 .. 1, as OpenGL has it.
  float depth(const Ray& ray, double t) const;
  bool is_perspective() const { return is_perspective_; }

 private:
  glm::dmat4 clip_from_world_{1.0};
  Vec3 clip_z_{0.0}, clip_w_{0.0};  ///< rows of it
  glm::dvec2 ndc_from_px_{1.0};
  bool is_perspective_ = false;
  Vec3 base_{0.0};                ///< the eye; or the point in the middle at depth 0.5
  Vec3 right_{0.0}, up_{0.0};     ///< of the direction, or of the origin, by NDC
  Vec3 forward_{0.0, 0.0, -1.0};  ///< direction in the middle
};

}  // namespace kerf
