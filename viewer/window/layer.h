// viewer/window/layer.h - a framebuffer with colour, depth and stencil. For the sources of viewer/
// only.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>

#include "base/result.h"
#include "viewer/gl_objects.h"
#include "viewer/picture.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

/// Colour and depth are textures, so that one layer can be laid over another. Without a size until
/// allocate(); pixels are undefined until drawn.
class Layer {
 public:
  /// Of this size from now on. Error: this OpenGL cannot, with the size.
  Done allocate(glm::ivec2 size_px);
  /// Gives the memory back.
  void release();
  bool is_allocated() const { return size_px_.x > 0; }

  /// What is drawn from now on goes into this rectangle of the layer.
  void bind(const ScreenRect& rect) const;
  /// Makes the rectangle that of `from`, depth included. Both have the same size. Ends bind().
  void copy(const Layer& from, const ScreenRect& rect);

  GLuint framebuffer() const { return framebuffer_.name(); }
  const GlTexture& color() const { return color_; }
  const GlTexture& depth() const { return depth_; }
  std::size_t gpu_bytes() const;

 private:
  glm::ivec2 size_px_{0};
  GlFramebuffer framebuffer_;
  GlTexture color_;
  GlTexture depth_;
};

/// Colour of a framebuffer of the current context, rows from the top.
Picture read_framebuffer(unsigned framebuffer, glm::ivec2 size_px);

}  // namespace kerf
