#include "viewer/window/layer.h"

namespace kerf {

void Layer::release() { *this = Layer(); }

void Layer::bind(const ScreenRect& rect) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer());
  glViewport(0, 0, size_px().x, size_px().y);
  glEnable(GL_SCISSOR_TEST);
  glScissor(rect.min.x, rect.min.y, rect.max.x - rect.min.x, rect.max.y - rect.min.y);
}

void Layer::copy(const Layer& from, const ScreenRect& rect) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer());
  glDisable(GL_SCISSOR_TEST);
  // The stencil is not needed, but depth and stencil share their words: both at once are a plain
  // copy of memory.
  glBlitFramebuffer(rect.min.x, rect.min.y, rect.max.x, rect.max.y, rect.min.x, rect.min.y,
                    rect.max.x, rect.max.y,
                    GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, GL_NEAREST);
}

}  // namespace kerf
