#include "viewer/render_target.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/translate.h"

namespace kerf {
namespace {

/// RGBA8, and 24 bits of depth with 8 of stencil.
constexpr std::size_t kBytesPerPixel = 8;

}  // namespace

Done RenderTarget::allocate(glm::ivec2 size_px) {
  if (size_px == size_px_) return std::monostate{};
  allocate_texture(color_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, size_px, GL_NEAREST);
  allocate_texture(depth_, GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, size_px,
                   GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.name(), 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth_.name(),
                         0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return Error{trf("OpenGL cannot draw a picture of {} x {} pixels", size_px.x, size_px.y)};
  }
  size_px_ = size_px;
  return std::monostate{};
}

std::size_t RenderTarget::gpu_bytes() const {
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
