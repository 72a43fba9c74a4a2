#include "viewer/raycast/ray_worker.h"

#include <algorithm>
#include <utility>

namespace kerf {
namespace {

constexpr int kCoarsest = 8;

/// Copies a rectangle of the picture that the caster has.
void copy_pixels(const RayCaster& caster, RayPicture* to) {
  const glm::ivec2 size = to->high_px - to->low_px;
  const auto count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  to->rgba.resize(4 * count);
  to->window_depths.resize(count);
  std::size_t at = 0;
  for (int y = to->low_px.y; y < to->high_px.y; ++y) {
    std::size_t from = static_cast<std::size_t>(y) * static_cast<std::size_t>(to->size_px.x) +
                       static_cast<std::size_t>(to->low_px.x);
    for (int x = 0; x < size.x; ++x, ++from, ++at) {
      const std::uint8_t* const rgb = &caster.picture().rgb[3 * from];
      to->rgba[4 * at] = rgb[0];
      to->rgba[4 * at + 1] = rgb[1];
      to->rgba[4 * at + 2] = rgb[2];
      to->rgba[4 * at + 3] = 255;
      to->window_depths[at] = caster.workpiece_depths()[from];
    }
  }
}

}  // namespace

RayWorker::RayWorker(int threads, std::function<void()> on_picture)
    : on_picture_(std::move(on_picture)),
      caster_(threads),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void RayWorker::set_workpiece(std::shared_ptr<const HeightGrid> grid) {
  // Whoever lets go of the last one frees a snapshot: not under the lock.
  std::shared_ptr<const HeightGrid> old;
  const std::lock_guard lock(mutex_);
  if (job_.grid == grid) return;
  old = std::exchange(job_.grid, std::move(grid));
  is_job_new_ = true;
  asked_.notify_one();
}

void RayWorker::look_from(const Projection& projection) {
  const std::lock_guard lock(mutex_);
  if (job_.projection == projection) return;
  job_.projection = projection;
  is_job_new_ = true;
  asked_.notify_one();
}

void RayWorker::begin_anew() {
  const std::lock_guard lock(mutex_);
  picture_.reset();
  job_.wants_whole = true;
  is_job_new_ = true;
  asked_.notify_one();
}

bool RayWorker::has_picture() const {
  const std::lock_guard lock(mutex_);
  return picture_ != nullptr;
}

std::unique_ptr<RayPicture> RayWorker::take() {
  const std::lock_guard lock(mutex_);
  return std::move(picture_);
}

void RayWorker::run(const std::stop_token& stop) {
  while (true) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      const auto is_asked = [this] { return is_job_new_; };
      if (divisor_ > 1) {
        asked_.wait_until(lock, stop, full_at_, is_asked);
      } else {
        asked_.wait(lock, stop, is_asked);
      }
      if (stop.stop_requested()) return;
      job = job_;
      job_.wants_whole = false;
      is_job_new_ = false;
    }
    make(job);
  }
}

void RayWorker::make(const Job& job) {
  if (job.grid != grid_) {
    grid_ = job.grid;
    caster_.set_workpiece(grid_);
  }
  if (!has_looked_ || job.projection != projection_) {
    has_looked_ = true;
    projection_ = job.projection;
    divisor_ = divisor_for(projection_.size_px);
    full_at_ = Clock::now() + std::chrono::milliseconds(kStill_ms);
  } else if (Clock::now() >= full_at_) {
    divisor_ = 1;
  }
  Projection cast = projection_;
  cast.size_px = (projection_.size_px + divisor_ - 1) / divisor_;
  const auto begin = Clock::now();
  const RayCounters counters = caster_.draw(cast);
  if (counters.cast_px == 0 && !job.wants_whole) return;
  if (counters.is_full) {
    const std::chrono::duration<double, std::nano> took = Clock::now() - begin;
    ns_per_pixel_ = took.count() / static_cast<double>(counters.cast_px);
  }
  publish(counters, cast.size_px, counters.is_full || job.wants_whole);
  if (on_picture_) on_picture_();
}

/// The least that draws a whole picture in time.
int RayWorker::divisor_for(glm::ivec2 size_px) const {
  int divisor = 1;
  const double whole_ms = 1e-6 * ns_per_pixel_ * size_px.x * size_px.y;
  while (divisor < kCoarsest && whole_ms / (divisor * divisor) > kMoving_ms) divisor *= 2;
  return divisor;
}

void RayWorker::publish(const RayCounters& counters, glm::ivec2 size_px, bool is_whole) {
  auto picture = std::make_unique<RayPicture>();
  picture->projection = projection_;
  picture->size_px = size_px;
  picture->low_px = is_whole ? glm::ivec2(0) : counters.low_px;
  picture->high_px = is_whole ? size_px : counters.high_px;
  picture->is_whole = is_whole;
  picture->has_workpiece = grid_ != nullptr;
  // What nobody has taken yet is in the caster still, unless all of it is new.
  const std::unique_ptr<RayPicture> untaken = take();
  if (untaken && !is_whole) {
    picture->low_px = glm::min(picture->low_px, untaken->low_px);
    picture->high_px = glm::max(picture->high_px, untaken->high_px);
    picture->is_whole = untaken->is_whole;
  }
  copy_pixels(caster_, picture.get());
  const std::lock_guard lock(mutex_);
  picture_ = std::move(picture);
}

}  // namespace kerf
