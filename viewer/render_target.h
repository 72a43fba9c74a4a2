// viewer/render_target.h - a framebuffer with colour, depth and stencil. For the sources of viewer/
// only.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>

#include "base/result.h"
#include "viewer/gl_objects.h"
#include "viewer/picture.h"

namespace kerf {

/// Colour and depth are textures, so that one can be laid over another. Without a size until
/// allocate(); pixels are undefined until drawn.
class RenderTarget {
 public:
  /// Of this size from now on; of the size that it has it keeps its pixels. Error: this OpenGL
  /// cannot, with the size.
  Done allocate(glm::ivec2 size_px);

  glm::ivec2 size_px() const { return size_px_; }
  GLuint framebuffer() const { return framebuffer_.name(); }
  const GlTexture& color() const { return color_; }
  const GlTexture& depth() const { return depth_; }
  std::size_t gpu_bytes() const;

 private:
  glm::ivec2 size_px_{0};
  GlFramebuffer framebuffer_;
  GlTexture color_;
  GlTexture depth_;  // and stencil
};

/// Colour of a framebuffer of the current context, rows from the top. Waits for the card.
Picture read_framebuffer(unsigned framebuffer, glm::ivec2 size_px);

}  // namespace kerf
