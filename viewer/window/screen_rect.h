// viewer/window/screen_rect.h - rectangles of pixels: what has to be drawn again.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "base/geometry.h"
#include "viewer/orbit_camera.h"

namespace kerf {

/// Pixels [min, max) from the lower left corner, as OpenGL counts them. Default: empty.
struct ScreenRect {
  glm::ivec2 min{0, 0};
  glm::ivec2 max{0, 0};

  static ScreenRect whole(glm::ivec2 size_px) { return {{0, 0}, size_px}; }
  bool empty() const { return min.x >= max.x || min.y >= max.y; }
  std::int64_t pixels() const;
  void extend(const ScreenRect& other);
  bool intersects(const ScreenRect& other) const;
  /// What lies in both; maybe empty.
  ScreenRect common(const ScreenRect& other) const;
  ScreenRect moved(glm::ivec2 by_px) const { return {min + by_px, max + by_px}; }
  /// The pixels that it touches in a picture whose edges are so many times as long, or such a part.
  ScreenRect times(int factor) const { return {min * factor, max * factor}; }
  ScreenRect divided(int divisor) const { return {min / divisor, (max + divisor - 1) / divisor}; }
  bool operator==(const ScreenRect&) const = default;
};

/// Adds a rectangle to some that do not overlap, so that they still do not: those that it overlaps
/// grow together with it, and those with which it does not cover more than `spare_px` pixels that
/// neither of the two does. O(rectangles), for each that it grows together with.
void add_apart(ScreenRect rect, std::vector<ScreenRect>* rects, std::int64_t spare_px = 0);

/// All pixels that something inside the box can touch, with a border for lines and markers. A box
/// that reaches the plane of the eye may touch any pixel.
ScreenRect covered_rect(const Box& box, const Projection& projection);

/// Box around the box moved by `pose`; empty if that is.
Box placed(const Box& box, const glm::mat4& pose);

/// Edge of a pixel, in mm, where the box is nearest to the eye; 0 if it reaches the plane of the
/// eye, or is empty.
double smallest_pixel_mm(const Box& box, const Projection& projection);

/// What is to be taken from the z of clip coordinates so that something lies `nearer_px` pixels
/// nearer to the eye than it does, at the same place of the picture.
float towards_eye(const Projection& projection, double nearer_px);

}  // namespace kerf
