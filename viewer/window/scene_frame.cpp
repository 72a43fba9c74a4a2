// What of the scene has changed, and a frame of it.
#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "base/translate.h"
#include "viewer/window/gl_failure.h"
#include "viewer/window/scene_renderer_impl.h"

namespace kerf {
namespace {

/// By which depth_box() grows beyond what is needed, relative to its size.
constexpr double kDepthReserve = 0.25;

}  // namespace

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
  path_.set_by_move(paints_path());
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
  std::string failure = present_gl_failure(counters.gpu_bytes);
  if (!programs_.trouble().empty()) failure = programs_.trouble();
  if (failure.empty()) return std::monostate{};
  is_kept_old_ = true;
  return Error{failure};
}

std::size_t SceneRenderer::Impl::gpu_bytes() const {
  return patches_.gpu_bytes() + path_.gpu_bytes() + bodies_.gpu_bytes() + colors_.gpu_bytes() +
         draw_modes_.gpu_bytes() + kept_.gpu_bytes() + glass_.gpu_bytes() + shown_.gpu_bytes();
}

}  // namespace kerf
