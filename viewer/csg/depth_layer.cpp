#include "viewer/csg/depth_layer.h"

#include <vector>

namespace kerf {

void DepthLayer::bind_textures(int color_unit, int depth_unit) const {
  bind_texture(depth_unit, depth());
  bind_texture(color_unit, color());
}

void DepthLayer::show_in(GLuint framebuffer, glm::ivec2 corner_px) const {
  const glm::ivec2 end_px = corner_px + size_px();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, this->framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, size_px().x, size_px().y, corner_px.x, corner_px.y, end_px.x, end_px.y,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

Picture DepthLayer::read() const { return read_framebuffer(framebuffer(), size_px()); }

DepthPicture DepthLayer::read_depth() const {
  DepthPicture picture{size_px().x, size_px().y, {}};
  const auto rows = static_cast<std::size_t>(size_px().y);
  const auto columns = static_cast<std::size_t>(size_px().x);
  std::vector<float> upward(rows * columns);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer());
  glReadPixels(0, 0, size_px().x, size_px().y, GL_DEPTH_COMPONENT, GL_FLOAT, upward.data());
  for (std::size_t row = rows; row-- > 0;) {
    const float* begin = upward.data() + row * columns;
    picture.depths.insert(picture.depths.end(), begin, begin + columns);
  }
  return picture;
}

}  // namespace kerf
