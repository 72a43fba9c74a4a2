// How the scene is drawn: what is kept, and what moves over it.
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "viewer/window/scene_renderer_impl.h"
#include "viewer/window/section_face.h"

namespace kerf {
namespace {

constexpr glm::vec3 kTraverseColor{0.80f, 0.22f, 0.16f};
constexpr glm::vec3 kFeedColor{0.10f, 0.42f, 0.78f};
constexpr glm::vec3 kPlannedColor{0.45f, 0.45f, 0.48f};
/// How much of their colour future segments keep; the rest is the background's.
constexpr float kFutureShare = 0.45f;
constexpr glm::vec3 kPaper{0.88f, 0.89f, 0.91f};
constexpr glm::vec3 kDarkRoom{0.13f, 0.14f, 0.16f};
/// Lines on dark ground are mixed with this much white.
constexpr float kDarkWhite = 0.35f;

glm::vec4 line_rgba(const glm::vec3& color, const ObjectLook& look, bool is_past, bool is_dark) {
  if (!look.is_visible) return glm::vec4(0.0f);
  const glm::vec3 seen = is_dark ? glm::mix(color, glm::vec3(1.0f), kDarkWhite) : color;
  const glm::vec3 ground = is_dark ? kDarkRoom : kPaper;
  return {is_past ? seen : glm::mix(ground, seen, kFutureShare), look.opacity};
}

}  // namespace

std::size_t SceneRenderer::Impl::draw_kept(const ScreenRect& rect) {
  kept_.bind(rect);
  glDepthMask(GL_TRUE);
  glClearDepth(1.0);
  glClearStencil(0);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glBindVertexArray(no_vertices_.name());
  programs_.background().use();
  programs_.background().set("darkness", options_.is_dark ? 1.0f : 0.0f);
  glDrawArrays(GL_TRIANGLES, 0, 3);

  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glDepthFunc(GL_LESS);
  std::size_t triangles = 0;
  if (is_glass()) {
    draw_lines(rect);
    glass_.bind(rect);
    glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    triangles = draw_workpiece(rect);
  } else {
    triangles = draw_workpiece(rect);
    draw_lines(rect);
  }
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  return triangles;
}

/// What lies on one of these is kept. None: there is no section.
std::vector<glm::dvec4> SceneRenderer::Impl::kept_sides() const {
  std::vector<glm::dvec4> sides;
  for (const auto* plane : {&options_.section, &options_.section_beside}) {
    const auto kept = *plane ? kept_side(**plane) : std::nullopt;
    if (kept) sides.push_back(*kept);
  }
  return sides;
}

/// The part of it that a plane of the section keeps; all of it without.
std::size_t SceneRenderer::Impl::draw_patches(const ScreenRect& rect,
                                              const std::optional<glm::dvec4>& section) {
  const auto use = [&](ScenePrograms::Paint paint) -> const GlProgram& {
    const GlProgram& program = programs_.workpiece(paint, section.has_value());
    program.use();
    program.set("clip_from_model", projection_.clip_from_world);
    program.set("view_from_model", projection_.view_from_world);
    program.set("up_view", up_view(projection_));
    program.set("rgba", glm::vec4(SurfaceColors::kCut, 1.0f));
    if (section) program.set("section", glm::vec4(*section));
    return program;
  };
  const ColorBy by = surface_by();
  const VertexData data = SurfaceColors::needs(by);
  colors_.bind(use(SurfaceColors::paint(by)), by, scale_);
  std::size_t triangles = patches_.draw(rect, data, true);
  if (data != VertexData::kNone) {
    use(ScenePrograms::Paint::kOne);
    triangles += patches_.draw(rect, data, false);
  }
  return triangles;
}

std::size_t SceneRenderer::Impl::draw_workpiece(const ScreenRect& rect) {
  if (!look(SceneObject::kWorkpiece).is_visible) return 0;
  if (draw_mode_ != DrawMode::kMesh) {
    draw_modes_.draw();
    return 0;
  }
  const std::vector<glm::dvec4> sides = kept_sides();
  std::size_t triangles = 0;
  if (sides.empty()) {
    glEnable(GL_CULL_FACE);  // what is closed shows no backs; cut open it does
    triangles = draw_patches(rect, std::nullopt);
  } else {
    glEnable(GL_CLIP_DISTANCE0);
    // Where the nearest triangle that is left shows its back, the plane goes through material.
    glEnable(GL_STENCIL_TEST);
    glStencilFuncSeparate(GL_FRONT, GL_ALWAYS, 0, 0xff);
    glStencilFuncSeparate(GL_BACK, GL_ALWAYS, 1, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  }
  for (const glm::dvec4& side : sides) triangles += draw_patches(rect, side);
  glDisable(GL_CULL_FACE);
  glDisable(GL_CLIP_DISTANCE0);
  draw_section_faces(sides);
  glDisable(GL_STENCIL_TEST);
  return triangles;
}

/// Where a ray comes into material out of what is taken away it does so through the nearer one of
/// those planes that it goes through from there.
void SceneRenderer::Impl::draw_section_faces(std::span<const glm::dvec4> kept) {
  glStencilFunc(GL_EQUAL, 1, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glDepthFunc(GL_ALWAYS);
  const GlProgram& program = programs_.section_face();
  program.use();
  program.set("middle_px", glm::vec2(0.5 * glm::dvec2(size_px_)));
  glBindVertexArray(no_vertices_.name());
  for (const glm::dvec4& side : kept) {
    const std::optional<glm::dvec3> depths = section_depths(side, projection_);
    if (!depths) continue;
    program.set("depth_plane", glm::vec3(*depths));
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LESS);
  }
  glDepthFunc(GL_LESS);
}

void SceneRenderer::Impl::draw_lines(const ScreenRect& rect) const {
  const auto colors = [this](bool is_past) {
    const bool is_dark = options_.is_dark;
    return std::array{line_rgba(kTraverseColor, look(SceneObject::kTraverses), is_past, is_dark),
                      line_rgba(kFeedColor, look(SceneObject::kFeeds), is_past, is_dark),
                      line_rgba(kPlannedColor, look(SceneObject::kPlanned), is_past, is_dark)};
  };
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  // The rims of smooth lines would leave pale borders in what is laid over them.
  const bool may_smooth = !is_glass();
  MovePaint moves;
  if (paints_path()) {
    moves = colors_.path_paint();
    moves.ground = options_.is_dark ? kDarkRoom : kPaper;
    moves.ground_share = 1.0f - kFutureShare;
  }
  path_.draw(rect, PathColors{colors(true), colors(false), moves}, may_smooth);
  const auto opacity = [this](SceneObject object) {
    return look(object).is_visible ? look(object).opacity : 0.0f;
  };
  markers_.draw(projection_,
                {opacity(SceneObject::kBlank), opacity(SceneObject::kFrames),
                 opacity(SceneObject::kFindings)},
                may_smooth);
  glDisable(GL_BLEND);
}

void SceneRenderer::Impl::draw_shown(ScreenRect rect) {
  const bool is_part_seen = setup_ && look(SceneObject::kWorkpiece).is_visible;
  rect.extend(
      bodies_.take_changed(projection_, options_.looks, is_part_seen ? setup_->bounds_mm : Box{}));
  if (rect.empty()) return;
  changed_.extend(rect);
  counters.shown_pixels += static_cast<std::uint64_t>(rect.pixels());
  shown_.copy(kept_, rect);
  shown_.bind(rect);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glDepthFunc(GL_LESS);
  bodies_.draw_hidden_marks(rect, programs_.moving());
  bodies_.draw(rect, programs_.moving(), true);
  draw_seen_through(rect);
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
}

void SceneRenderer::Impl::draw_moving_beside_glass(const ScreenRect& rect, bool is_behind) const {
  const GlProgram& program = programs_.moving_beside_glass();
  program.use();
  bind_texture(0, glass_.depth());
  program.set("glass_depths", 0);
  program.set("is_behind", is_behind ? 1 : 0);
  bodies_.draw(rect, program, false);
}

/// What is seen through, over what is not: first what lies behind the surface of a transparent
/// workpiece, then that surface, then the rest.
void SceneRenderer::Impl::draw_seen_through(const ScreenRect& rect) {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glEnable(GL_CULL_FACE);
  if (is_glass()) {
    draw_moving_beside_glass(rect, true);
    draw_glass();
    draw_moving_beside_glass(rect, false);
  } else {
    bodies_.draw(rect, programs_.moving(), false);
  }
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void SceneRenderer::Impl::draw_glass() {
  const GlProgram& program = programs_.glass();
  program.use();
  bind_texture(0, glass_.depth());
  bind_texture(1, glass_.color());
  program.set("glass_depths", 0);
  program.set("glass_colors", 1);
  program.set("opacity", look(SceneObject::kWorkpiece).opacity);
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace kerf
