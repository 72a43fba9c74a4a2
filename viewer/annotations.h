// viewer/annotations.h - what is drawn around a part: outline and sizes of the blank, axes,
// caption.
#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/geometry.h"
#include "viewer/camera.h"
#include "viewer/labels.h"
#include "viewer/scene.h"
#include "viewer/standing.h"

namespace kerf {

/// Lays lines and lettering out for one picture:
///
///          +---------+        outline of the blank, faint where the part covers it
///    Z   |/         /|
///   size +---------+ |        dimension lines with a ruler division beside three of its edges
///        |    Z    | +
///        |    |_X  |/  /
///        +---------+  / Y size
///         ---------
///          X size
///
/// In a lathe it is diameter and length, and the outline is what set_outline() was given.
///
/// Lengths in pixels grow with the picture, so that a large one can be scaled down.
class Annotations {
 public:
  /// `blank_mm` may be empty: then only axes and caption are drawn. `part_mm`: bounds of the mesh,
  /// may be empty too; not both. `direction`: from the part to the eye, as for Camera::fit.
  Annotations(const Box& blank_mm, const Box& part_mm, const Vec3& direction, glm::ivec2 picture_px,
              Standing standing = Standing::kOnTable);

  /// Of the blank, instead of its box.
  void set_outline(std::vector<LineSegment> outline) { outline_ = std::move(outline); }

  /// All that has to be inside the margins.
  std::vector<Vec3> points_to_fit() const;
  Margins margins() const;

  std::vector<Stroke> layout(const Camera& camera, std::string_view caption) const;

 private:
  /// A dimension line parallel to the edge from `from_mm` to `to_mm`, moved by `offset_mm`.
  enum class Side { kBelow, kLeft, kRight };  // of the part
  struct Dimension {
    const char* name;
    Side side;
    Vec3 from_mm;
    Vec3 to_mm;
    Vec3 offset_mm;
  };

  std::vector<Dimension> box_dimensions(const Vec3& right, double offset_mm) const;
  std::vector<Dimension> turned_dimensions(double offset_mm) const;
  static std::string label_of(const Dimension& dimension);
  void add_outline(const Camera& camera, std::vector<Stroke>* strokes) const;
  void add_dimension(const Dimension& dimension, const Camera& camera,
                     std::vector<Stroke>* strokes) const;
  void add_axes(const Camera& camera, std::vector<Stroke>* strokes) const;
  void add_caption(std::string_view caption, std::vector<Stroke>* strokes) const;

  Box blank_mm_;
  Box scene_mm_;
  glm::vec2 picture_px_;
  Vec3 direction_;
  Standing standing_;
  std::vector<LineSegment> outline_;
  float unit_px_ = 1.0f;  // 1 at 1600 x 1200
  float cap_height_px_ = 1.0f;
  bool origin_is_near_ = false;
  double axis_length_mm_ = 0.0;
  std::vector<Dimension> dimensions_;
};

}  // namespace kerf
