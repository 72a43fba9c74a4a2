#include "viewer/window/layer.h"

#include <fmt/format.h>

#include <algorithm>

namespace kerf {
namespace {

/// RGBA8, and 24 bits of depth with 8 of stencil.
constexpr std::size_t kBytesPerPixel = 8;

}  // namespace

Done Layer::allocate(glm::ivec2 size_px) {
  if (size_px == size_px_) return std::monostate{};
  allocate_texture(color_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, size_px, GL_NEAREST);
  allocate_texture(depth_, GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, size_px,
                   GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.name(), 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth_.name(),
                         0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return Error{
        fmt::format("OpenGL cannot draw a picture of {} x {} pixels", size_px.x, size_px.y)};
  }
  size_px_ = size_px;
  return std::monostate{};
}

void Layer::release() { *this = Layer(); }

void Layer::bind(const ScreenRect& rect) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, size_px_.x, size_px_.y);
  glEnable(GL_SCISSOR_TEST);
  glScissor(rect.min.x, rect.min.y, rect.max.x - rect.min.x, rect.max.y - rect.min.y);
}

void Layer::copy(const Layer& from, const ScreenRect& rect) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.framebuffer_.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
  glDisable(GL_SCISSOR_TEST);
  // The stencil is not needed, but depth and stencil share their words: both at once are a plain
  // copy of memory.
  glBlitFramebuffer(rect.min.x, rect.min.y, rect.max.x, rect.max.y, rect.min.x, rect.min.y,
                    rect.max.x, rect.max.y,
                    GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, GL_NEAREST);
}

std::size_t Layer::gpu_bytes() const {
  return kBytesPerPixel * static_cast<std::size_t>(size_px_.x) *
         static_cast<std::size_t>(size_px_.y);
}

Picture read_framebuffer(unsigned framebuffer, glm::ivec2 size_px) {
  Picture picture{size_px.x, size_px.y, {}};
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(size_px.x);
  const auto rows = static_cast<std::size_t>(size_px.y);
  picture.rgb.resize(row_bytes * rows);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size_px.x, size_px.y, GL_RGB, GL_UNSIGNED_BYTE, picture.rgb.data());
  for (std::size_t y = 0; y < rows / 2; ++y) {
    std::swap_ranges(&picture.rgb[y * row_bytes], &picture.rgb[y * row_bytes] + row_bytes,
                     &picture.rgb[(rows - 1 - y) * row_bytes]);
  }
  return picture;
}

}  // namespace kerf
