#include "viewer/csg/depth_layer.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

namespace kerf {
namespace {

/// RGBA8, and 24 bits of depth with 8 of stencil.
constexpr std::size_t kBytesPerPixel = 8;

}  // namespace

Done DepthLayer::allocate(glm::ivec2 size_px) {
  if (size_px == size_px_) return std::monostate{};
  allocate_texture(colors_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, size_px, GL_NEAREST);
  allocate_texture(depths_, GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, size_px,
                   GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colors_.name(), 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depths_.name(),
                         0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return Error{
        fmt::format("OpenGL cannot draw a picture of {} x {} pixels", size_px.x, size_px.y)};
  }
  size_px_ = size_px;
  return std::monostate{};
}

void DepthLayer::bind_textures(int color_unit, int depth_unit) const {
  bind_texture(depth_unit, depths_);
  bind_texture(color_unit, colors_);
}

void DepthLayer::show_in(GLuint framebuffer, glm::ivec2 corner_px) const {
  const glm::ivec2 end_px = corner_px + size_px_;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, size_px_.x, size_px_.y, corner_px.x, corner_px.y, end_px.x, end_px.y,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

Picture DepthLayer::read() const {
  Picture picture{size_px_.x, size_px_.y, {}};
  const auto rows = static_cast<std::size_t>(size_px_.y);
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(size_px_.x);
  std::vector<std::uint8_t> upward(rows * row_bytes);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size_px_.x, size_px_.y, GL_RGB, GL_UNSIGNED_BYTE, upward.data());
  for (std::size_t row = rows; row-- > 0;) {
    const std::uint8_t* begin = upward.data() + row * row_bytes;
    picture.rgb.insert(picture.rgb.end(), begin, begin + row_bytes);
  }
  return picture;
}

DepthPicture DepthLayer::read_depth() const {
  DepthPicture picture{size_px_.x, size_px_.y, {}};
  const auto rows = static_cast<std::size_t>(size_px_.y);
  const auto columns = static_cast<std::size_t>(size_px_.x);
  std::vector<float> upward(rows * columns);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
  glReadPixels(0, 0, size_px_.x, size_px_.y, GL_DEPTH_COMPONENT, GL_FLOAT, upward.data());
  for (std::size_t row = rows; row-- > 0;) {
    const float* begin = upward.data() + row * columns;
    picture.depths.insert(picture.depths.end(), begin, begin + columns);
  }
  return picture;
}

std::size_t DepthLayer::gpu_bytes() const {
  return kBytesPerPixel * static_cast<std::size_t>(size_px_.x) *
         static_cast<std::size_t>(size_px_.y);
}

}  // namespace kerf
