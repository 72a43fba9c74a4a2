#include "viewer/window/workpiece_renderer.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "viewer/shaders/shaders.h"

namespace kerf {
namespace {

constexpr int kMostThreads = 8;
/// RGBA8 and a float of depth.
constexpr std::size_t kRayBytesPerPixel = 8;

/// One core stays for the window.
int ray_threads() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()) - 1, 1, kMostThreads);
}

}  // namespace

WorkpieceRenderer::WorkpieceRenderer(GlProgram program, std::function<void()> wake)
    : program_(std::move(program)), wake_(std::move(wake)) {}

Result<WorkpieceRenderer> WorkpieceRenderer::create(std::function<void()> wake) {
  Result<GlProgram> program = GlProgram::create(shaders::screen_vert, shaders::workpiece_frag);
  if (!program) return Error{program.error()};
  return WorkpieceRenderer(std::move(*program), std::move(wake));
}

void WorkpieceRenderer::apply(const SceneUpdate& update) {
  if (update.clears) {
    answer_.reset();
    heights_.reset();
    csg_.release();
  }
  if (update.draw_mode) answer_ = update.draw_mode;
  if (update.heights) heights_ = update.heights;
  if (update.cut_moves) csg_.set(update.cut_moves);
}

/// What the others hold is large, and who owns the workpiece has stopped telling them of it.
void WorkpieceRenderer::release_others(DrawMode draw_mode) {
  if (draw_mode_ == draw_mode) return;
  draw_mode_ = draw_mode;
  if (draw_mode != DrawMode::kRaycast) {
    heights_.reset();
    // The thread stays: to end it may take as long as a picture.
    if (worker_) worker_->set_workpiece(nullptr);
  } else {
    ray_projection_.reset();
    if (worker_) worker_->begin_anew();
  }
  if (draw_mode != DrawMode::kCsg) csg_.release();
}

Result<WorkpieceRenderer::Step> WorkpieceRenderer::prepare(const Projection& wanted,
                                                           DrawMode draw_mode) {
  release_others(draw_mode);
  is_full_ = true;
  Step step;
  step.projection = wanted;
  if (!answer_ || answer_->draw_mode != draw_mode || !answer_->is_drawn()) return step;
  if (draw_mode == DrawMode::kRaycast && heights_) cast(wanted, &step);
  if (draw_mode == DrawMode::kCsg && csg_.has_moves()) {
    if (Done done = csg_.draw(wanted); !done) return Error{done.error()};
    if (!csg_.shown()) return step;
    step.draw_mode = DrawMode::kCsg;
    step.projection = *csg_.shown();
    step.projection.size_px = wanted.size_px;
    step.is_all_new = csg_.is_all_new();
    step.changed = csg_.changed();
    is_full_ = csg_.is_full();
  }
  return step;
}

void WorkpieceRenderer::cast(const Projection& wanted, Step* step) {
  if (!worker_) {
    worker_ = std::make_unique<RayWorker>(ray_threads(), wake_);
    worker_->begin_anew();
  }
  worker_->look_from(wanted);
  worker_->set_workpiece(heights_);
  const std::unique_ptr<RayPicture> picture = worker_->take();
  if (picture && !ray_projection_ && !(picture->is_whole && picture->has_workpiece)) {
    // One that was asked for before the workpiece came shows nothing, and what follows it may be
    // the rest alone.
    worker_->begin_anew();
  } else if (picture) {
    step->is_all_new = picture->is_whole || picture->size_px != wanted.size_px;
    if (!step->is_all_new) {
      step->changed = {{picture->low_px.x, wanted.size_px.y - picture->high_px.y},
                       {picture->high_px.x, wanted.size_px.y - picture->low_px.y}};
    }
    upload(*picture);
  }
  if (!ray_projection_) return;
  is_full_ = *ray_projection_ == wanted && ray_size_px_ == wanted.size_px;
  step->draw_mode = DrawMode::kRaycast;
  step->projection = *ray_projection_;
  step->projection.size_px = wanted.size_px;
}

void WorkpieceRenderer::upload(const RayPicture& picture) {
  if (picture.size_px != ray_size_px_) {
    allocate_texture(ray_colors_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, picture.size_px, GL_NEAREST);
    allocate_texture(ray_depths_, GL_R32F, GL_RED, GL_FLOAT, picture.size_px, GL_NEAREST);
    ray_size_px_ = picture.size_px;
  }
  const glm::ivec2 size = picture.high_px - picture.low_px;
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  bind_texture(0, ray_colors_);
  glTexSubImage2D(GL_TEXTURE_2D, 0, picture.low_px.x, picture.low_px.y, size.x, size.y, GL_RGBA,
                  GL_UNSIGNED_BYTE, picture.rgba.data());
  bind_texture(0, ray_depths_);
  glTexSubImage2D(GL_TEXTURE_2D, 0, picture.low_px.x, picture.low_px.y, size.x, size.y, GL_RED,
                  GL_FLOAT, picture.window_depths.data());
  ray_projection_ = picture.projection;
}

void WorkpieceRenderer::draw() const {
  program_.use();
  program_.set("colors", 0);
  program_.set("depths", 1);
  program_.set("is_from_top", draw_mode_ == DrawMode::kRaycast ? 1 : 0);
  if (draw_mode_ == DrawMode::kRaycast) {
    bind_texture(1, ray_depths_);
    bind_texture(0, ray_colors_);
  } else {
    csg_.bind(0, 1);
  }
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

bool WorkpieceRenderer::has_waiting() const {
  if (draw_mode_ == DrawMode::kRaycast) return worker_ && worker_->has_picture();
  return draw_mode_ == DrawMode::kCsg && csg_.has_waiting();
}

std::size_t WorkpieceRenderer::gpu_bytes() const {
  return csg_.gpu_bytes() + kRayBytesPerPixel * static_cast<std::size_t>(ray_size_px_.x) *
                                static_cast<std::size_t>(ray_size_px_.y);
}

}  // namespace kerf
