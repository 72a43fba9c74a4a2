// viewer/window/panel_layer.h - the content of the window, kept from frame to frame. For the
// sources of viewer/ only: includes the GL header.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>

#include "viewer/gl_objects.h"
#include "viewer/picture.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

/// A framebuffer as large as the window. While only the picture between the panels changes, the
/// panels stay in it as they are: drawing their letters costs a software renderer more than the
/// picture does. (The window's own back buffer has no content that one could count on.)
class PanelLayer {
 public:
  /// Its content is undefined after a change of size. Error: more than this OpenGL can do.
  Done resize(glm::ivec2 size_px);
  glm::ivec2 size_px() const { return size_px_; }
  /// To be drawn into.
  GLuint framebuffer() const { return framebuffer_.name(); }
  /// Copies a rectangle of it to the back buffer of the window.
  void show(const ScreenRect& rect) const;
  /// What is shown.
  Picture read() const;
  std::size_t gpu_bytes() const;

 private:
  GlFramebuffer framebuffer_;
  GlRenderbuffer color_;
  glm::ivec2 size_px_{0};
};

}  // namespace kerf
