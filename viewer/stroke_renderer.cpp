#include "viewer/stroke_renderer.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

#include "viewer/shaders/shaders.h"

namespace kerf {
namespace {

/// Lets the outline of the blank win over faces of the part that lie in it. A share of the depth
/// range of the scene.
constexpr float kDepthBias = 0.004f;
constexpr float kFringe_px = 1.0f;  // for the antialiased border

struct StrokeVertex {
  glm::vec3 position;
  glm::vec4 shape;
  glm::vec4 rgba;
  float hidden_alpha;
};

void add_quad(const Stroke& stroke, std::vector<StrokeVertex>* vertices) {
  const glm::vec2 along_px = stroke.to_px - stroke.from_px;
  const float length_px = glm::length(along_px);
  const glm::vec2 u = length_px > 0.0f ? along_px / length_px : glm::vec2(1, 0);
  const glm::vec2 v(-u.y, u.x);
  // Strokes thinner than a pixel are drawn one pixel wide and paler.
  const float half_px = 0.5f * std::max(stroke.width_px, 1.0f);
  const float reach_px = half_px + kFringe_px;
  glm::vec4 rgba = stroke.rgba;
  rgba.a *= std::min(stroke.width_px, 1.0f);
  const auto vertex = [&](bool at_end, float side) {
    const float x = at_end ? length_px + reach_px : -reach_px;
    const float y = side * reach_px;
    const glm::vec2 px = stroke.from_px + u * x + v * y;
    return StrokeVertex{glm::vec3(px, at_end ? stroke.to_depth : stroke.from_depth),
                        glm::vec4(x, y, length_px, half_px), rgba, stroke.hidden_alpha};
  };
  const StrokeVertex a = vertex(false, -1), b = vertex(true, -1), c = vertex(true, 1),
                     d = vertex(false, 1);
  vertices->insert(vertices->end(), {a, b, c, a, c, d});
}

void float_attribute(GLuint index, GLint components, std::size_t offset) {
  glEnableVertexAttribArray(index);
  glVertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, sizeof(StrokeVertex),
                        reinterpret_cast<const void*>(offset));
}

}  // namespace

Result<StrokeRenderer> StrokeRenderer::create() {
  Result<GlProgram> program = GlProgram::create(shaders::stroke_vert, shaders::stroke_frag);
  if (!program) return Error{program.error()};
  return StrokeRenderer(std::move(*program));
}

void StrokeRenderer::draw(std::span<const Stroke> strokes, glm::ivec2 picture_px,
                          const GlTexture& depths) const {
  if (strokes.empty()) return;
  std::vector<StrokeVertex> vertices;
  vertices.reserve(strokes.size() * 6);
  for (const Stroke& stroke : strokes) add_quad(stroke, &vertices);

  GlVertexArray array;
  GlBuffer buffer;
  glBindVertexArray(array.name());
  glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(StrokeVertex)),
               vertices.data(), GL_STREAM_DRAW);
  float_attribute(0, 3, offsetof(StrokeVertex, position));
  float_attribute(1, 4, offsetof(StrokeVertex, shape));
  float_attribute(2, 4, offsetof(StrokeVertex, rgba));
  float_attribute(3, 1, offsetof(StrokeVertex, hidden_alpha));

  program_.use();
  program_.set("picture_px", glm::vec2(picture_px));
  program_.set("depths", 0);
  program_.set("depth_bias", kDepthBias);
  bind_texture(0, depths);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
  glDisable(GL_BLEND);
  glBindVertexArray(0);
}

}  // namespace kerf
