#include "viewer/window/scene_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <span>
#include <utility>

#include "viewer/gl_objects.h"
#include "viewer/shaders/shaders.h"
#include "viewer/window/marker_store.h"
#include "viewer/window/patch_store.h"
#include "viewer/window/path_store.h"
#include "viewer/window/tool_store.h"

namespace kerf {
namespace {

constexpr glm::vec3 kWorkpieceColor{0.72f, 0.74f, 0.77f};
constexpr glm::vec3 kTraverseColor{0.80f, 0.22f, 0.16f};
constexpr glm::vec3 kFeedColor{0.10f, 0.42f, 0.78f};
constexpr glm::vec3 kPlannedColor{0.45f, 0.45f, 0.48f};
/// How much of their colour future segments keep; the rest is the background's.
constexpr float kFutureShare = 0.45f;
constexpr glm::vec3 kPaper{0.88f, 0.89f, 0.91f};
/// By which depth_box() grows beyond what is needed, relative to its size.
constexpr double kDepthReserve = 0.25;
constexpr double kSmallestScene_mm = 10.0;

/// Framebuffer with colour and depth.
struct Layer {
  GlFramebuffer framebuffer;
  GlRenderbuffer color;
  GlRenderbuffer depth;

  Done allocate(glm::ivec2 size_px) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glBindRenderbuffer(GL_RENDERBUFFER, color.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, size_px.x, size_px.y);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color.name());
    glBindRenderbuffer(GL_RENDERBUFFER, depth.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, size_px.x, size_px.y);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth.name());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      return Error{
          fmt::format("OpenGL cannot draw a picture of {} x {} pixels", size_px.x, size_px.y)};
    }
    return std::monostate{};
  }
};

void scissor(const ScreenRect& rect) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(rect.min.x, rect.min.y, rect.max.x - rect.min.x, rect.max.y - rect.min.y);
}

void copy(const Layer& from, const Layer& to, const ScreenRect& rect) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.framebuffer.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.framebuffer.name());
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(rect.min.x, rect.min.y, rect.max.x, rect.max.y, rect.min.x, rect.min.y,
                    rect.max.x, rect.max.y, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

glm::vec4 shade(const glm::vec3& color, const ObjectLook& look, bool is_past) {
  if (!look.is_visible) return glm::vec4(0.0f);
  return {is_past ? color : glm::mix(kPaper, color, kFutureShare), look.opacity};
}

/// Times what the card does without waiting for it: the answer comes some frames later.
class GpuTimer {
 public:
  GpuTimer() { glGenQueries(1, &query_); }
  GpuTimer(const GpuTimer&) = delete;
  GpuTimer& operator=(const GpuTimer&) = delete;
  ~GpuTimer() { glDeleteQueries(1, &query_); }

  void begin() {
    if (sink_) return;
    glBeginQuery(GL_TIME_ELAPSED, query_);
    is_running_ = true;
  }
  /// `sink` gets the time found; frames of its kind that pass meanwhile count like this one.
  void end(double* sink) {
    if (is_running_) {
      glEndQuery(GL_TIME_ELAPSED);
      is_running_ = false;
      sink_ = sink;
      repeats_ = 1;
    } else if (sink_ == sink) {
      ++repeats_;
    }
  }
  void collect() {
    if (!sink_) return;
    GLint is_there = GL_FALSE;
    glGetQueryObjectiv(query_, GL_QUERY_RESULT_AVAILABLE, &is_there);
    if (is_there != GL_TRUE) return;
    GLuint64 elapsed_ns = 0;
    glGetQueryObjectui64v(query_, GL_QUERY_RESULT, &elapsed_ns);
    *sink_ += static_cast<double>(elapsed_ns) * 1e-6 * repeats_;
    sink_ = nullptr;
  }

 private:
  GLuint query_ = 0;
  bool is_running_ = false;
  int repeats_ = 0;
  double* sink_ = nullptr;
};

}  // namespace

class SceneRenderer::Impl {
 public:
  struct Programs {
    GlProgram background;
    GlProgram scene;
  };

  Impl(Programs programs, PathStore path, MarkerStore markers)
      : programs_(std::move(programs)), path_(std::move(path)), markers_(std::move(markers)) {
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &max_size_px_);
  }

  void apply(const SceneUpdate& update);
  Done draw(const Projection& projection, const DrawOptions& options);
  bool has_waiting() const { return patches_.waiting_bytes() > 0 || path_.has_waiting(); }
  void show_in(GLuint framebuffer, glm::ivec2 corner_px) const;
  Picture read() const { return read_framebuffer(shown_.framebuffer.name(), size_px_); }
  std::optional<Vec3> pick(glm::ivec2 px) const;
  Box fit_box() const;
  const Box& depth_box() const { return depth_box_; }

  DrawCounters counters;

 private:
  void grow_depth_box(const Box& box);
  Done resize(glm::ivec2 size_px);
  ScreenRect changed_rect(std::span<const Box> changed_mm) const;
  std::size_t draw_kept(const ScreenRect& rect);
  std::size_t draw_workpiece(const ScreenRect& rect) const;
  void draw_lines(const ScreenRect& rect) const;
  void draw_shown(ScreenRect rect);
  const ObjectLook& look(SceneObject object) const {
    return options_.looks[static_cast<std::size_t>(object)];
  }

  Programs programs_;
  GlVertexArray no_vertices_;
  PatchStore patches_;
  PathStore path_;
  MarkerStore markers_;
  ToolStore tool_;
  Layer kept_;
  Layer shown_;
  GpuTimer timer_;

  std::shared_ptr<const SceneSetup> setup_;
  Box path_box_;
  Box depth_box_{Vec3(-kSmallestScene_mm), Vec3(kSmallestScene_mm)};
  bool has_content_ = false;
  Projection projection_;
  DrawOptions options_;
  GLint max_size_px_ = 1;
  glm::ivec2 size_px_{0};
  bool is_kept_old_ = true;  // all of it
  std::vector<Box> changed_mm_;
  ScreenRect tool_rect_;  // where the tool is in shown_
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
  if (update.tool_shape) tool_.set_shape(*update.tool_shape);
  if (update.moment) {
    tool_.set_pose(update.moment->tool_pose);
    path_.set_past(update.moment->past_vertices, &changed_mm_);
  }
}

Done SceneRenderer::Impl::resize(glm::ivec2 size_px) {
  if (size_px == size_px_) return std::monostate{};
  if (std::max(size_px.x, size_px.y) > max_size_px_) {
    return Error{fmt::format("this OpenGL draws at most {} x {} pixels; the window has {} x {}",
                             max_size_px_, max_size_px_, size_px.x, size_px.y)};
  }
  for (Layer* layer : {&kept_, &shown_}) {
    if (Done done = layer->allocate(size_px); !done) return done;
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

Done SceneRenderer::Impl::draw(const Projection& projection, const DrawOptions& options) {
  if (Done done = resize(projection.size_px); !done) return done;
  timer_.collect();
  timer_.begin();
  if (projection != projection_ || options.looks != options_.looks || !options.is_local) {
    is_kept_old_ = true;
  }
  if (projection != projection_) {
    projection_ = projection;
    patches_.project(projection);
    path_.project(projection);
  }
  options_ = options;
  const bool drew_skirts = patches_.draws_skirts();
  std::size_t bytes = patches_.upload(options.upload_bytes_per_frame, &changed_mm_);
  if (bytes < options.upload_bytes_per_frame) {
    bytes += path_.upload(options.upload_bytes_per_frame - bytes, &changed_mm_);
  }
  if (patches_.draws_skirts() != drew_skirts) is_kept_old_ = true;
  const ScreenRect rect = is_kept_old_ ? ScreenRect::whole(size_px_) : changed_rect(changed_mm_);
  DrawCounters::Kind& kind = is_kept_old_   ? counters.full
                             : rect.empty() ? counters.still
                                            : counters.local;
  if (!rect.empty()) kind.triangles += draw_kept(rect);
  draw_shown(rect);
  timer_.end(&kind.ms);
  ++kind.frames;
  kind.pixels += static_cast<std::uint64_t>(rect.pixels());
  if (!rect.empty()) counters.last_rect = rect;
  counters.uploaded_bytes += bytes;
  counters.waiting_bytes = patches_.waiting_bytes();
  counters.gpu_bytes = patches_.gpu_bytes() + path_.gpu_bytes();
  changed_mm_.clear();
  is_kept_old_ = false;
  return std::monostate{};
}

std::size_t SceneRenderer::Impl::draw_kept(const ScreenRect& rect) {
  glBindFramebuffer(GL_FRAMEBUFFER, kept_.framebuffer.name());
  glViewport(0, 0, size_px_.x, size_px_.y);
  scissor(rect);
  glDepthMask(GL_TRUE);
  glClearDepth(1.0);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glBindVertexArray(no_vertices_.name());
  programs_.background.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);

  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glDepthFunc(GL_LESS);
  // Lines lie behind a transparent workpiece, so they come first then.
  const bool is_opaque = look(SceneObject::kWorkpiece).opacity >= 1.0f;
  if (!is_opaque) draw_lines(rect);
  const std::size_t triangles = draw_workpiece(rect);
  if (is_opaque) draw_lines(rect);
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  return triangles;
}

std::size_t SceneRenderer::Impl::draw_workpiece(const ScreenRect& rect) const {
  const ObjectLook& workpiece = look(SceneObject::kWorkpiece);
  if (!workpiece.is_visible) return 0;
  const bool is_opaque = workpiece.opacity >= 1.0f;
  programs_.scene.use();
  programs_.scene.set("clip_from_model", projection_.clip_from_world);
  programs_.scene.set("view_from_model", projection_.view_from_world);
  programs_.scene.set("up_view", glm::vec3(projection_.view_from_world[2]));
  programs_.scene.set("rgba", glm::vec4(kWorkpieceColor, workpiece.opacity));
  if (!is_opaque) {
    // What lies behind, the tool too, shines through: no depth is kept.
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glEnable(GL_CULL_FACE);
  }
  const std::size_t triangles = patches_.draw(rect);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  return triangles;
}

void SceneRenderer::Impl::draw_lines(const ScreenRect& rect) const {
  const auto colors = [this](bool is_past) {
    return std::array{shade(kTraverseColor, look(SceneObject::kTraverses), is_past),
                      shade(kFeedColor, look(SceneObject::kFeeds), is_past),
                      shade(kPlannedColor, look(SceneObject::kPlanned), is_past)};
  };
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  path_.draw(rect, PathColors{colors(true), colors(false)});
  const auto opacity = [this](SceneObject object) {
    return look(object).is_visible ? look(object).opacity : 0.0f;
  };
  markers_.draw(projection_, {opacity(SceneObject::kBlank), opacity(SceneObject::kFrames),
                              opacity(SceneObject::kFindings)});
  glDisable(GL_BLEND);
}

void SceneRenderer::Impl::draw_shown(ScreenRect rect) {
  const ToolLook tool_look{look(SceneObject::kCutter).is_visible,
                           look(SceneObject::kHolder).is_visible,
                           look(SceneObject::kCutter).opacity, look(SceneObject::kHolder).opacity};
  const ScreenRect tool_rect = tool_.rect(projection_, tool_look);
  if (tool_.take_changed() || tool_rect != tool_rect_) {
    rect.extend(tool_rect_);
    rect.extend(tool_rect);
  } else if (rect.intersects(tool_rect)) {
    rect.extend(tool_rect);
  }
  tool_rect_ = tool_rect;
  if (rect.empty()) return;
  copy(kept_, shown_, rect);
  if (tool_rect.empty()) return;
  glBindFramebuffer(GL_FRAMEBUFFER, shown_.framebuffer.name());
  glViewport(0, 0, size_px_.x, size_px_.y);
  scissor(tool_rect);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glDepthFunc(GL_LESS);
  programs_.scene.use();
  programs_.scene.set("up_view", glm::vec3(projection_.view_from_world[2]));
  tool_.draw(projection_, programs_.scene, tool_look);
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
}

void SceneRenderer::Impl::show_in(GLuint framebuffer, glm::ivec2 corner_px) const {
  const glm::ivec2 end_px = corner_px + size_px_;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, shown_.framebuffer.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, size_px_.x, size_px_.y, corner_px.x, corner_px.y, end_px.x, end_px.y,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

std::optional<Vec3> SceneRenderer::Impl::pick(glm::ivec2 px) const {
  if (px.x < 0 || px.y < 0 || px.x >= size_px_.x || px.y >= size_px_.y) return std::nullopt;
  float depth = 1.0f;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, kept_.framebuffer.name());
  glReadPixels(px.x, size_px_.y - 1 - px.y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
  if (depth >= 1.0f) return std::nullopt;
  const glm::dvec2 uv((px.x + 0.5) / size_px_.x, 1.0 - (px.y + 0.5) / size_px_.y);
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

Result<SceneRenderer> SceneRenderer::create() {
  Result<GlProgram> background = GlProgram::create(shaders::screen_vert, shaders::background_frag);
  Result<GlProgram> scene = GlProgram::create(shaders::scene_vert, shaders::scene_frag);
  for (const auto* program : {&background, &scene}) {
    if (!*program) return Error{program->error()};
  }
  Result<PathStore> path = PathStore::create();
  if (!path) return Error{path.error()};
  Result<MarkerStore> markers = MarkerStore::create();
  if (!markers) return Error{markers.error()};
  return SceneRenderer(
      std::make_unique<Impl>(Impl::Programs{std::move(*background), std::move(*scene)},
                             std::move(*path), std::move(*markers)));
}

SceneRenderer::SceneRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;
SceneRenderer::~SceneRenderer() = default;
void SceneRenderer::apply(const SceneUpdate& update) { impl_->apply(update); }
Done SceneRenderer::draw(const Projection& projection, const DrawOptions& options) {
  return impl_->draw(projection, options);
}
bool SceneRenderer::has_waiting() const { return impl_->has_waiting(); }
void SceneRenderer::show_in(unsigned framebuffer, glm::ivec2 corner_px) const {
  impl_->show_in(framebuffer, corner_px);
}
void SceneRenderer::finish() const { glFinish(); }
std::string SceneRenderer::gl_name() {
  const auto string_of = [](GLenum name) {
    const GLubyte* value = glGetString(name);
    return value != nullptr ? std::string(reinterpret_cast<const char*>(value)) : "?";
  };
  return fmt::format("OpenGL {}, {}", string_of(GL_VERSION), string_of(GL_RENDERER));
}
Picture SceneRenderer::read() const { return impl_->read(); }
std::optional<Vec3> SceneRenderer::pick(glm::ivec2 px) const { return impl_->pick(px); }
Box SceneRenderer::fit_box() const { return impl_->fit_box(); }
const Box& SceneRenderer::depth_box() const { return impl_->depth_box(); }
const DrawCounters& SceneRenderer::counters() const { return impl_->counters; }
void SceneRenderer::reset_counters() { impl_->counters = {}; }

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
