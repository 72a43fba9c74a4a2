#include "viewer/window/panel_layer.h"

#include <fmt/format.h>

#include "base/translate.h"
#include "viewer/window/layer.h"

namespace kerf {
namespace {

constexpr std::size_t kBytesPerPixel = 4;  // RGBA8

}  // namespace

Done PanelLayer::resize(glm::ivec2 size_px) {
  if (size_px == size_px_) return std::monostate{};
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindRenderbuffer(GL_RENDERBUFFER, color_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, size_px.x, size_px.y);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_.name());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return Error{trf("OpenGL cannot draw a window of {} x {} pixels", size_px.x, size_px.y)};
  }
  size_px_ = size_px;
  return std::monostate{};
}

void PanelLayer::show(const ScreenRect& rect) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(rect.min.x, rect.min.y, rect.max.x, rect.max.y, rect.min.x, rect.min.y,
                    rect.max.x, rect.max.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

Picture PanelLayer::read() const { return read_framebuffer(framebuffer_.name(), size_px_); }

std::size_t PanelLayer::gpu_bytes() const {
  return kBytesPerPixel * static_cast<std::size_t>(size_px_.x) *
         static_cast<std::size_t>(size_px_.y);
}

}  // namespace kerf
