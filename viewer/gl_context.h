// viewer/gl_context.h - an OpenGL 3.3 core context without a window.
#pragma once

#include "base/result.h"

namespace kerf {

/// Makes OpenGL usable on the calling thread through EGL: Mesa's surfaceless platform (software
/// rendering without any GPU), else the first EGL device that works. Needs no DISPLAY, no X server,
/// no Wayland. There is no default framebuffer: draw into framebuffer objects. The context is
/// current on the thread that created it until the object is destroyed, and must outlive every GL
/// object made in it. One at a time: EGL displays are shared by the whole process.
class GlContext {
 public:
  /// Error: every draw mode that was tried, each with its reason, and the packages to install.
  static Result<GlContext> create_offscreen();

  GlContext(GlContext&& other) noexcept;
  GlContext& operator=(GlContext&& other) noexcept;
  ~GlContext();

 private:
  GlContext(void* display, void* context) : display_(display), context_(context) {}
  void* display_ = nullptr;  // EGLDisplay; void so that EGL headers stay in the source file.
  void* context_ = nullptr;  // EGLContext
};

}  // namespace kerf
