#include "viewer/window/scene_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <span>
#include <utility>

#include "base/translate.h"
#include "viewer/gl_objects.h"
#include "viewer/window/gl_failure.h"
#include "viewer/window/gpu_timer.h"
#include "viewer/window/layer.h"
#include "viewer/window/marker_store.h"
#include "viewer/window/moving_bodies.h"
#include "viewer/window/patch_store.h"
#include "viewer/window/path_store.h"
#include "viewer/window/scene_pace.h"
#include "viewer/window/scene_programs.h"
#include "viewer/window/section_face.h"
#include "viewer/window/surface_colors.h"
#include "viewer/window/workpiece_renderer.h"

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
/// By which depth_box() grows beyond what is needed, relative to its size.
constexpr double kDepthReserve = 0.25;
constexpr double kSmallestScene_mm = 10.0;

glm::vec4 line_rgba(const glm::vec3& color, const ObjectLook& look, bool is_past, bool is_dark) {
  if (!look.is_visible) return glm::vec4(0.0f);
  const glm::vec3 seen = is_dark ? glm::mix(color, glm::vec3(1.0f), kDarkWhite) : color;
  const glm::vec3 ground = is_dark ? kDarkRoom : kPaper;
  return {is_past ? seen : glm::mix(ground, seen, kFutureShare), look.opacity};
}

bool is_software() {
  const std::string name = SceneRenderer::gl_name();
  return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos;
}

}  // namespace

class SceneRenderer::Impl {
 public:
  Impl(ScenePrograms programs, PathStore path, MarkerStore markers, WorkpieceRenderer draw_modes)
      : programs_(std::move(programs)),
        path_(std::move(path)),
        markers_(std::move(markers)),
        draw_modes_(std::move(draw_modes)) {
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_size_px_);
  }

  void apply(const SceneUpdate& update);
  Done draw(const Projection& projection, const DrawOptions& options);
  void keep_pace() { pace_.emplace(); }
  bool has_waiting() const {
    return (pace_ && pace_->has_waiting()) || patches_.waiting_bytes() > 0 || path_.has_waiting() ||
           bodies_.has_waiting() || draw_modes_.has_waiting();
  }
  bool is_full() const { return divisor_ == 1 && draw_modes_.is_full(); }
  ScreenRect take_changed() {
    return std::exchange(changed_, {}).times(divisor_).common(ScreenRect::whole(full_px_));
  }
  void show_in(GLuint framebuffer, glm::ivec2 corner_px, const ScreenRect& rect) const;
  Picture read() const { return read_framebuffer(shown_.framebuffer(), size_px_); }
  std::optional<Vec3> pick(glm::ivec2 px) const;
  Box fit_box() const;
  const Box& depth_box() const { return depth_box_; }
  std::vector<ColorLegendEntry> legend(const Measures& measures) const {
    if (draw_mode_ != DrawMode::kMesh) return {};
    return colors_.legend(shown_by_, scale_, measures);
  }
  DrawMode drawn_mode() const { return draw_mode_; }
  const Projection& projection() const { return full_projection_; }

  DrawCounters counters;

 private:
  void grow_depth_box(const Box& box);
  Done resize(glm::ivec2 size_px);
  Done take_options(const Projection& projection, const DrawOptions& options);
  void set_divisor(int divisor);
  std::size_t upload(std::size_t budget_bytes);
  ScreenRect changed_rect(std::span<const Box> changed_mm) const;
  std::size_t draw_kept(const ScreenRect& rect);
  std::size_t draw_workpiece(const ScreenRect& rect);
  std::vector<glm::dvec4> kept_sides() const;
  std::size_t draw_patches(const ScreenRect& rect, const std::optional<glm::dvec4>& section);
  void draw_section_faces(std::span<const glm::dvec4> kept);
  void draw_lines(const ScreenRect& rect) const;
  void draw_shown(ScreenRect rect);
  void draw_moving_beside_glass(const ScreenRect& rect, bool is_behind) const;
  void draw_seen_through(const ScreenRect& rect);
  void draw_glass();
  std::size_t gpu_bytes() const;
  const ObjectLook& look(SceneObject object) const {
    return options_.looks[static_cast<std::size_t>(object)];
  }
  /// Drawn into a layer of its own, since the tool has to be seen through it.
  bool is_glass() const {
    const ObjectLook& workpiece = look(SceneObject::kWorkpiece);
    return workpiece.is_visible && workpiece.opacity < 1.0f;
  }

  ScenePrograms programs_;
  GlVertexArray no_vertices_;
  PatchStore patches_;
  SurfaceColors colors_;
  PathStore path_;
  MarkerStore markers_;
  MovingBodies bodies_;
  WorkpieceRenderer draw_modes_;
  DrawMode draw_mode_ = DrawMode::kMesh;  // drawn last
  Layer kept_;
  Layer glass_;
  Layer shown_;
  GpuTimer timer_{is_software()};
  bool is_full_timed_ = false;  // what is timed is a whole picture

  std::shared_ptr<const SceneSetup> setup_;
  Box path_box_;
  Box depth_box_{Vec3(-kSmallestScene_mm), Vec3(kSmallestScene_mm)};
  bool has_content_ = false;
  std::optional<ScenePace> pace_;
  int divisor_ = 1;             // of the picture last drawn
  glm::ivec2 full_px_{1};       // its size as asked for
  Projection full_projection_;  // for that size
  Projection projection_;       // for its own
  DrawOptions options_;
  ColorBy shown_by_ = ColorBy::kPlain;
  ColorScale scale_;
  GLint max_size_px_ = 1;
  glm::ivec2 size_px_{0};
  bool is_kept_old_ = true;  // all of it
  std::vector<Box> changed_mm_;
  ScreenRect changed_;  // of shown_, since take_changed()
};

void SceneRenderer::Impl::grow_depth_box(const Box& box) {
  if (box.empty()) return;
  Box wanted = has_content_ ? depth_box_ : Box{};
  wanted.extend(box);
  if (has_content_ && wanted == depth_box_) return;
  const Vec3 reserve = kDepthReserve * wanted.size() + Vec3(1.0);
  depth_box_ = {wanted.min - reserve, wanted.max + reserve};
  has_content_ = true;
}

void SceneRenderer::Impl::apply(const SceneUpdate& update) {
  if (update.clears) {
    patches_.clear();
    path_.clear();
    path_box_ = {};
    markers_.set_findings({});
    depth_box_ = {Vec3(-kSmallestScene_mm), Vec3(kSmallestScene_mm)};
    has_content_ = false;
    if (setup_) grow_depth_box(setup_->bounds_mm);
    is_kept_old_ = true;
  }
  if (update.setup) {
    setup_ = update.setup;
    grow_depth_box(setup_->bounds_mm);
    markers_.set_setup(*setup_);
    is_kept_old_ = true;
  }
  if (update.findings) {
    markers_.set_findings(update.findings->findings);
    is_kept_old_ = true;
  }
  for (const auto& patch : update.patches) {
    patches_.offer(patch);
    Box box;
    for (const MeshVertex& vertex : patch->vertices) box.extend(Vec3(vertex.position_mm));
    grow_depth_box(box);
  }
  if (update.path_chunk_count) path_.set_chunk_count(*update.path_chunk_count);
  for (const auto& chunk : update.path) {
    path_.offer(chunk);
    Box box;
    for (const PathVertex& vertex : chunk->vertices) box.extend(Vec3(vertex.position_mm));
    path_box_.extend(box);
    grow_depth_box(box);
  }
  draw_modes_.apply(update);
  bodies_.apply(update);
  if (update.colors) {
    colors_.set(update.colors);
    if (update.colors->mode == options_.color_by) is_kept_old_ = true;
  }
  if (update.moment) path_.set_past(update.moment->past_vertices, &changed_mm_);
  if (update.tool_shape || update.machine || update.fixtures || update.moment) {
    grow_depth_box(bodies_.bounds_mm());
  }
}

Done SceneRenderer::Impl::resize(glm::ivec2 size_px) {
  const bool needs_glass = is_glass();
  if (!needs_glass) glass_.release();
  if (size_px == size_px_ && needs_glass == glass_.is_allocated()) return std::monostate{};
  if (std::max(size_px.x, size_px.y) > max_size_px_) {
    return Error{trf("this OpenGL draws at most {} x {} pixels; the window has {} x {}",
                     max_size_px_, max_size_px_, size_px.x, size_px.y)};
  }
  for (Layer* layer : {&kept_, &shown_}) {
    if (Done done = layer->allocate(size_px); !done) return done;
  }
  if (needs_glass) {
    if (Done done = glass_.allocate(size_px); !done) return done;
  }
  size_px_ = size_px;
  is_kept_old_ = true;
  return std::monostate{};
}

ScreenRect SceneRenderer::Impl::changed_rect(std::span<const Box> changed_mm) const {
  ScreenRect rect;
  for (const Box& box : changed_mm) rect.extend(covered_rect(box, projection_));
  return rect;
}

/// Notes what makes the whole kept scene old.
Done SceneRenderer::Impl::take_options(const Projection& projection, const DrawOptions& options) {
  DrawOptions without_budget = options;
  without_budget.upload_bytes_per_frame = options_.upload_bytes_per_frame;
  if (without_budget != options_ || !options.is_local) is_kept_old_ = true;
  options_ = options;
  path_.set_tail(options.path_tail);
  if (Done done = resize(projection.size_px); !done) return done;
  if (projection != projection_) {
    is_kept_old_ = true;
    projection_ = projection;
    patches_.project(projection);
    path_.project(projection);
  }
  return std::monostate{};
}

/// What is in another size is no picture any more.
void SceneRenderer::Impl::set_divisor(int divisor) {
  if (divisor == divisor_) return;
  changed_ = {};
  divisor_ = divisor;
}

std::size_t SceneRenderer::Impl::upload(std::size_t budget_bytes) {
  std::size_t bytes = patches_.upload(budget_bytes, &changed_mm_);
  if (bytes < budget_bytes) bytes += path_.upload(budget_bytes - bytes, &changed_mm_);
  if (bytes < budget_bytes) bytes += bodies_.upload(budget_bytes - bytes);
  return bytes;
}

Done SceneRenderer::Impl::draw(const Projection& projection, const DrawOptions& options) {
  const Result<WorkpieceRenderer::Step> step = draw_modes_.prepare(projection, options.draw_mode);
  if (!step) return Error{step.error()};
  if (std::exchange(draw_mode_, step->draw_mode) != step->draw_mode || step->is_all_new)
    is_kept_old_ = true;
  const std::optional<double> whole_ms = timer_.collect();
  if (pace_ && whole_ms && is_full_timed_) pace_->took(*whole_ms);
  set_divisor(pace_ ? pace_->divisor(projection, ScenePace::Clock::now()) : 1);
  full_projection_ = step->projection;
  full_px_ = projection.size_px;
  Projection drawn = step->projection;
  drawn.size_px = ScreenRect::whole(full_px_).divided(divisor_).max;
  drawn.line_px = std::max(1.0f, projection.line_px / static_cast<float>(divisor_));
  if (Done done = take_options(drawn, options); !done) return done;
  timer_.begin();
  const std::size_t bytes = upload(options.upload_bytes_per_frame);
  const Box heights = setup_ && !setup_->bounds_mm.empty() ? setup_->bounds_mm
                      : patches_.bounds_mm().empty()       ? Box{Vec3(0.0), Vec3(0.0)}
                                                           : patches_.bounds_mm();
  const ColorScale scale{heights.min.z, heights.max.z, std::max(options.tolerance_mm, 1e-9)};
  const ColorBy shown_by = colors_.available(options.color_by);
  if (shown_by != shown_by_ || (shown_by != ColorBy::kPlain && scale != scale_)) {
    is_kept_old_ = true;
  }
  scale_ = scale;
  shown_by_ = shown_by;
  ScreenRect rect = step->changed.divided(divisor_);
  rect.extend(changed_rect(changed_mm_));
  if (is_kept_old_) rect = ScreenRect::whole(size_px_);
  DrawCounters::Kind& kind = is_kept_old_   ? counters.full
                             : rect.empty() ? counters.still
                                            : counters.local;
  glCullFace(GL_BACK);  // others that draw in this context may have chosen otherwise
  if (!rect.empty()) kind.triangles += draw_kept(rect);
  draw_shown(rect);
  if (timer_.end(&kind.ms)) is_full_timed_ = is_kept_old_;
  ++kind.frames;
  kind.pixels += static_cast<std::uint64_t>(rect.pixels());
  if (!rect.empty()) counters.last_rect = rect;
  counters.uploaded_bytes += bytes;
  counters.waiting_bytes = patches_.waiting_bytes();
  counters.gpu_bytes = gpu_bytes();
  changed_mm_.clear();
  is_kept_old_ = false;
  const std::string failure = present_gl_failure(counters.gpu_bytes);
  if (failure.empty()) return std::monostate{};
  is_kept_old_ = true;
  return Error{failure};
}

std::size_t SceneRenderer::Impl::gpu_bytes() const {
  return patches_.gpu_bytes() + path_.gpu_bytes() + bodies_.gpu_bytes() + colors_.gpu_bytes() +
         draw_modes_.gpu_bytes() + kept_.gpu_bytes() + glass_.gpu_bytes() + shown_.gpu_bytes();
}

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
  const VertexData data = SurfaceColors::needs(shown_by_);
  colors_.bind(use(SurfaceColors::paint(shown_by_)), shown_by_, scale_);
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
  path_.draw(rect, PathColors{colors(true), colors(false)}, may_smooth);
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
double SceneRenderer::detail_px() { return is_software() ? 2.0 : 1.0; }
std::size_t SceneRenderer::easy_triangles() { return is_software() ? 20'000 : 0; }
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
