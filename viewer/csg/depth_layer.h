// viewer/csg/depth_layer.h - a picture with depth and stencil on the graphics card. For the sources
// of viewer/ only.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>

#include "base/result.h"
#include "viewer/csg/depth_picture.h"
#include "viewer/gl_objects.h"
#include "viewer/picture.h"

namespace kerf {

/// Texture-backed, so that layers can be laid over each other. Without a size until allocate();
/// pixels are undefined until drawn.
class DepthLayer {
 public:
  /// Of this size from now on; of the size that it has it keeps its pixels. Error: this OpenGL
  /// cannot, with the size.
  Done allocate(glm::ivec2 size_px);

  GLuint framebuffer() const { return framebuffer_.name(); }
  glm::ivec2 size_px() const { return size_px_; }
  void bind_textures(int color_unit, int depth_unit) const;
  /// Copies it to a framebuffer (0: the window's), from its pixel `corner_px` (counted from the
  /// lower left) on.
  void show_in(GLuint framebuffer, glm::ivec2 corner_px) const;
  /// Waits for the card; both.
  Picture read() const;
  DepthPicture read_depth() const;
  std::size_t gpu_bytes() const;

 private:
  glm::ivec2 size_px_{0};
  GlFramebuffer framebuffer_;
  GlTexture colors_;
  GlTexture depths_;  // and stencil
};

}  // namespace kerf
