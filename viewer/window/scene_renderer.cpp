#include "viewer/window/scene_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/matrix.hpp>
#include <string>
#include <utility>

#include "viewer/window/scene_renderer_impl.h"

namespace kerf {

bool is_software_gl() {
  const std::string name = SceneRenderer::gl_name();
  return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos;
}

void SceneRenderer::Impl::show_in(GLuint framebuffer, glm::ivec2 corner_px,
                                  const ScreenRect& rect) const {
  const ScreenRect from = rect.divided(divisor_);
  const ScreenRect to = from.times(divisor_).moved(corner_px);
  const ScreenRect within = rect.moved(corner_px);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, shown_.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  // Of pixels that are blown up, some reach beyond the rectangle.
  glEnable(GL_SCISSOR_TEST);
  glScissor(within.min.x, within.min.y, within.max.x - within.min.x, within.max.y - within.min.y);
  glBlitFramebuffer(from.min.x, from.min.y, from.max.x, from.max.y, to.min.x, to.min.y, to.max.x,
                    to.max.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

std::optional<Vec3> SceneRenderer::Impl::pick(glm::ivec2 px) const {
  if (px.x < 0 || px.y < 0 || px.x >= full_px_.x || px.y >= full_px_.y) return std::nullopt;
  const glm::ivec2 at = glm::ivec2(px.x, full_px_.y - 1 - px.y) / divisor_;
  float depth = 1.0f;
  for (const Layer* layer : {&kept_, &glass_}) {
    if (!layer->is_allocated()) continue;
    float found = 1.0f;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, layer->framebuffer());
    glReadPixels(at.x, at.y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &found);
    depth = std::min(depth, found);
  }
  if (depth >= 1.0f) return std::nullopt;
  const glm::dvec2 uv = (glm::dvec2(at) + 0.5) / glm::dvec2(size_px_);
  const glm::dvec4 ndc(uv * 2.0 - 1.0, 2.0 * static_cast<double>(depth) - 1.0, 1.0);
  const glm::dvec4 world = glm::inverse(glm::dmat4(projection_.clip_from_world)) * ndc;
  return Vec3(world) / world.w;
}

Box SceneRenderer::Impl::fit_box() const {
  Box box;
  if (setup_) box = setup_->bounds_mm;
  if (box.empty()) {
    box.extend(patches_.bounds_mm());
    box.extend(path_box_);
  }
  return box;
}

Result<SceneRenderer> SceneRenderer::create(std::function<void()> wake) {
  Result<ScenePrograms> programs = ScenePrograms::create();
  if (!programs) return Error{programs.error()};
  Result<PathStore> path = PathStore::create();
  if (!path) return Error{path.error()};
  Result<MarkerStore> markers = MarkerStore::create();
  if (!markers) return Error{markers.error()};
  Result<WorkpieceRenderer> draw_modes = WorkpieceRenderer::create(std::move(wake));
  if (!draw_modes) return Error{draw_modes.error()};
  release_gl_compiler();
  return SceneRenderer(std::make_unique<Impl>(std::move(*programs), std::move(*path),
                                              std::move(*markers), std::move(*draw_modes)));
}

SceneRenderer::SceneRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;
SceneRenderer::~SceneRenderer() = default;
void SceneRenderer::apply(const SceneUpdate& update) { impl_->apply(update); }
Done SceneRenderer::draw(const Projection& projection, const DrawOptions& options) {
  return impl_->draw(projection, options);
}
void SceneRenderer::keep_pace() { impl_->keep_pace(); }
bool SceneRenderer::has_waiting() const { return impl_->has_waiting(); }
bool SceneRenderer::is_full() const { return impl_->is_full(); }
DrawMode SceneRenderer::drawn_mode() const { return impl_->drawn_mode(); }
const Projection& SceneRenderer::projection() const { return impl_->projection(); }
ScreenRect SceneRenderer::take_changed() { return impl_->take_changed(); }
void SceneRenderer::show_in(unsigned framebuffer, glm::ivec2 corner_px,
                            const ScreenRect& rect) const {
  impl_->show_in(framebuffer, corner_px, rect);
}
void SceneRenderer::finish() const { glFinish(); }
std::string SceneRenderer::gl_name() {
  const auto string_of = [](GLenum name) {
    const GLubyte* value = glGetString(name);
    return value != nullptr ? std::string(reinterpret_cast<const char*>(value)) : "?";
  };
  return fmt::format("OpenGL {}, {}", string_of(GL_VERSION), string_of(GL_RENDERER));
}
double SceneRenderer::detail_px() { return is_software_gl() ? 2.0 : 1.0; }
std::size_t SceneRenderer::easy_triangles() { return is_software_gl() ? 20'000 : 0; }
Picture SceneRenderer::read() const { return impl_->read(); }
std::optional<Vec3> SceneRenderer::pick(glm::ivec2 px) const { return impl_->pick(px); }
Box SceneRenderer::fit_box() const { return impl_->fit_box(); }
std::vector<ColorLegendEntry> SceneRenderer::legend(const Measures& measures) const {
  return impl_->legend(measures);
}
const Box& SceneRenderer::depth_box() const { return impl_->depth_box(); }
const DrawCounters& SceneRenderer::counters() const { return impl_->counters; }
void SceneRenderer::reset_counters() { impl_->counters = {}; }

}  // namespace kerf
