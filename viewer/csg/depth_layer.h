// viewer/csg/depth_layer.h - a picture with depth and stencil on the graphics card. For the sources
// of viewer/ only.
#pragma once

#include <glm/vec2.hpp>

#include "viewer/csg/depth_picture.h"
#include "viewer/render_target.h"

namespace kerf {

/// See RenderTarget.
class DepthLayer : public RenderTarget {
 public:
  void bind_textures(int color_unit, int depth_unit) const;
  /// Copies it to a framebuffer (0: the window's), from its pixel `corner_px` (counted from the
  /// lower left) on.
  void show_in(GLuint framebuffer, glm::ivec2 corner_px) const;
  /// Waits for the card; both.
  Picture read() const;
  DepthPicture read_depth() const;
};

}  // namespace kerf
