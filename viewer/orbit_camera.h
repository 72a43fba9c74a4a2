// viewer/orbit_camera.h - the eye of the window, moved by the mouse.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "base/geometry.h"
#include "viewer/standing.h"
#include "viewer/view_detail.h"

namespace kerf {

enum class StandardView { kFront, kBack, kLeft, kRight, kTop, kBottom, kIsometric };

/// A drawing instead of a space: orthographic, moved and zoomed but never turned.
enum class FlatView {
  kNone,
  kXy,  ///< from above: sheet, drilling
  kZx,  ///< for turning: Z to the right, X up
};

/// What the renderer needs of a camera. Equal projections draw equal pictures.
struct Projection {
  glm::mat4 clip_from_world{1.0f};
  glm::mat4 view_from_world{1.0f};
  glm::ivec2 size_px{1, 1};
  float line_px = 1.0f;            ///< Width of the lines in the picture, 1 or more.
  glm::vec3 up{0.0f, 0.0f, 1.0f};  ///< In the workpiece frame: where the light comes from.
  bool operator==(const Projection&) const = default;
};

/// Looks at a target point from a direction given by two angles; +Z, or what stands for it
/// (set_standing()), stays up. Perspective and
/// orthographic views show the same extent at the target. Pixels count from the upper left corner.
class OrbitCamera {
 public:
  /// A drag across the whole height of the picture turns by half a turn.
  void orbit(glm::vec2 drag_px, glm::ivec2 size_px);
  /// The point of the target plane under the cursor stays under it.
  void pan(glm::vec2 drag_px, glm::ivec2 size_px);
  /// Above 1 goes nearer; what is in the target plane under the cursor stays there.
  void zoom(double factor, glm::vec2 cursor_px, glm::ivec2 size_px);
  /// Moves target and extent so that the box is seen whole; the direction stays. An empty box
  /// changes nothing.
  void fit(const Box& box, glm::ivec2 size_px);
  void look_from(StandardView view);
  /// All directions by name and angle are of this way up; those that were set go along.
  void set_standing(Standing standing) { standing_ = standing; }
  /// The eye is so far around +Z from +X, and so far above the XY plane, of the frame of views
  /// (viewer/standing.h). Not in a flat view.
  void look_from(double yaw_rad, double pitch_rad);

  void set_perspective(bool is_perspective) { is_perspective_ = is_perspective; }
  /// False in a flat view, whatever was set.
  bool is_perspective() const { return is_perspective_ && flat_ == FlatView::kNone; }
  /// While flat, orbit() and look_from() have no effect until kNone is set again.
  void set_flat(FlatView flat) { flat_ = flat; }
  FlatView flat() const { return flat_; }

  /// The depth range covers `content`, which must not be empty.
  Projection projection(const Box& content, glm::ivec2 size_px) const;
  ViewDetail detail(glm::ivec2 size_px) const;
  /// Edge of a pixel in the target plane.
  double pixel_mm(glm::ivec2 size_px) const;

 private:
  struct Axes {
    Vec3 right, up, back;
  };
  Axes axes() const;
  double distance_mm() const;
  Vec3 in_target_plane(glm::vec2 px, glm::ivec2 size_px) const;  // relative to the target

  Vec3 target_mm_{0.0};
  double yaw_rad_ = -1.0303768;   // of the eye around +Z, from +X
  double pitch_rad_ = 0.6346148;  // of the eye above the XY plane
  double extent_mm_ = 100.0;      // height of the picture in the target plane
  bool is_perspective_ = true;
  FlatView flat_ = FlatView::kNone;
  Standing standing_ = Standing::kOnTable;
};

/// Projection::up in view space.
inline glm::vec3 up_view(const Projection& projection) {
  return glm::mat3(projection.view_from_world) * projection.up;
}

/// Where a point is in the picture, pixels from its upper left corner; none behind the eye.
std::optional<glm::vec2> picture_px(const Vec3& point_mm, const Projection& projection);

}  // namespace kerf
