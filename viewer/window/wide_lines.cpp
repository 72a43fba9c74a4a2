#include "viewer/window/wide_lines.h"

#include <string>
#include <utility>

#include "viewer/shaders/shaders.h"

namespace kerf {
namespace {

/// Of the two triangles of a line.
constexpr int kCorners = 6;
/// Those before are of the vertices and of the colours of moves.
constexpr int kNumberUnit = 2;

}  // namespace

void WideLines::use(const Projection& projection, float towards_eye) const {
  if (!program_) {
    Result<GlProgram> made = GlProgram::create(shaders::line_vert, shaders::line_frag);
    program_ = made ? std::move(*made) : GlProgram::stand_in();
    release_gl_compiler();
  }
  program_->use();
  program_->set("clip_from_world", projection.clip_from_world);
  program_->set("towards_eye", towards_eye);
  program_->set("picture_px", glm::vec2(projection.size_px));
  program_->set("half_px", 0.5f * projection.line_px);
  program_->set("ends", 0);
  program_->set("step", 1);
  program_->set("is_smooth", 1);
  program_->set("numbers", kNumberUnit);
  program_->set("is_numbered", 0);
  program_->set("single", glm::ivec2(-1));
  set_moves(*program_, {});
}

void WideLines::set_kind_colors(std::span<const glm::vec4, 6> rgba) const {
  program_->set("by_kind", 1);
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    program_->set(("rgba[" + std::to_string(i) + "]").c_str(), rgba[i]);
  }
}

void WideLines::set_own_colors(float opacity) const {
  program_->set("by_kind", 0);
  program_->set("opacity", opacity);
}

void WideLines::bind(const GlTexture& texture, const GlBuffer& vertices) const {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_BUFFER, texture.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32UI, vertices.name());
}

void WideLines::set_numbered(bool is_numbered) const {
  program_->set("is_numbered", is_numbered ? 1 : 0);
}

void WideLines::bind_numbers(const GlTexture& texture, const GlBuffer& numbers) const {
  glActiveTexture(GL_TEXTURE0 + kNumberUnit);
  glBindTexture(GL_TEXTURE_BUFFER, texture.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_R16UI, numbers.name());
  glActiveTexture(GL_TEXTURE0);
}

void WideLines::draw_strip(int first, int count) const {
  if (count > 1) glDrawArrays(GL_TRIANGLES, kCorners * first, kCorners * (count - 1));
}

void WideLines::draw_pairs(int count) const {
  program_->set("step", 2);
  glDrawArrays(GL_TRIANGLES, 0, kCorners * (count / 2));
  program_->set("step", 1);
}

void WideLines::draw_one(int from, int to) const {
  program_->set("single", glm::ivec2(from, to));
  glDrawArrays(GL_TRIANGLES, 0, kCorners);
  program_->set("single", glm::ivec2(-1));
}

}  // namespace kerf
