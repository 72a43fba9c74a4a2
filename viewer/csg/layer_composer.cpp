#include "viewer/csg/layer_composer.h"

#include <utility>

#include "viewer/shaders/shaders.h"

namespace kerf {
namespace {

/// Walls thinner than this, in steps of the depth buffer and in shares of the slope per pixel, are
/// none: a cut exactly through the floor opens it.
constexpr float kFilm_steps = 8.0f;
constexpr float kFilm_slope = 0.02f;

}  // namespace

Result<LayerComposer> LayerComposer::create() {
  Result<GlProgram> background = GlProgram::create(shaders::screen_vert, shaders::background_frag);
  Result<GlProgram> inside = GlProgram::create(shaders::screen_vert, shaders::csg_inside_frag);
  Result<GlProgram> layer = GlProgram::create(shaders::screen_vert, shaders::csg_layer_frag);
  for (const auto* program : {&background, &inside, &layer}) {
    if (!*program) return Error{program->error()};
  }
  return LayerComposer(Programs{std::move(*background), std::move(*inside), std::move(*layer)});
}

/// Leaves the stencil above 0 where the kept point is inside the blank: more backs than fronts
/// behind it (those before it may be behind the eye). Within the scissor rectangle.
void LayerComposer::count_inside(const DepthLayer& layer, const std::function<void()>& draw_blank) {
  glBindFramebuffer(GL_FRAMEBUFFER, layer.framebuffer());
  glEnable(GL_STENCIL_TEST);
  glStencilMask(0xff);
  glClearStencil(0);
  glClear(GL_STENCIL_BUFFER_BIT);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  glStencilFunc(GL_ALWAYS, 0, 0xff);
  glStencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_INCR_WRAP);
  glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_DECR_WRAP);
  glDisable(GL_CULL_FACE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(-kFilm_slope, -kFilm_steps);
  draw_blank();
  glDisable(GL_POLYGON_OFFSET_FILL);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
}

/// Of the framebuffer that is bound: alpha becomes 1 where count_inside() left the stencil above 0,
/// else 0.
void LayerComposer::keep_inside_as_alpha() const {
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
  glDepthMask(GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  glStencilFunc(GL_NOTEQUAL, 0, 0xff);
  programs_.inside.use();
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

/// The layer as it is, with its stencil. Pixels are copied, not drawn: most pictures have no other
/// layer, and the copy is a tenth of the work. Copies within a scissor rectangle are no plain ones.
void LayerComposer::copy(const DepthLayer& layer, const PixelRect& rect) const {
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, layer.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, shown_.framebuffer());
  glBlitFramebuffer(rect.min.x, rect.min.y, rect.max.x, rect.max.y, rect.min.x, rect.min.y,
                    rect.max.x, rect.max.y,
                    GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, GL_NEAREST);
  glEnable(GL_SCISSOR_TEST);
}

/// Where the stencil is 0.
void LayerComposer::fill_background() const {
  glBindFramebuffer(GL_FRAMEBUFFER, shown_.framebuffer());
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 0, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glDisable(GL_CULL_FACE);
  glDepthFunc(GL_ALWAYS);
  glDepthRange(1.0, 1.0);
  programs_.background.use();
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthRange(0.0, 1.0);
}

/// Where its alpha is 1 and it is nearer than what is shown.
void LayerComposer::lay_over(const DepthLayer& layer) const {
  glBindFramebuffer(GL_FRAMEBUFFER, shown_.framebuffer());
  glDisable(GL_STENCIL_TEST);
  glDepthFunc(GL_LESS);
  programs_.layer.use();
  programs_.layer.set("colors", 0);
  programs_.layer.set("depths", 1);
  layer.bind_textures(0, 1);
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

Done LayerComposer::compose(std::span<const DepthLayer* const> layers, glm::ivec2 size_px,
                            const PixelRect& rect, const std::function<void()>& draw_blank) {
  if (rect.empty()) return std::monostate{};
  if (Done done = shown_.allocate(size_px); !done) return done;
  glEnable(GL_SCISSOR_TEST);
  glScissor(rect.min.x, rect.min.y, rect.max.x - rect.min.x, rect.max.y - rect.min.y);
  if (layers.empty()) {
    glBindFramebuffer(GL_FRAMEBUFFER, shown_.framebuffer());
    glClearStencil(0);
    glClear(GL_STENCIL_BUFFER_BIT);
  } else {
    count_inside(*layers.front(), draw_blank);
    copy(*layers.front(), rect);
  }
  fill_background();
  for (std::size_t i = 1; i < layers.size(); ++i) {
    count_inside(*layers[i], draw_blank);
    keep_inside_as_alpha();
    lay_over(*layers[i]);
  }
  glDisable(GL_SCISSOR_TEST);
  return std::monostate{};
}

}  // namespace kerf
