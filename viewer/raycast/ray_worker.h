// viewer/raycast/ray_worker.h - rays in a thread of their own, for a window that must not wait.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "surface/height_grid.h"
#include "viewer/orbit_camera.h"
#include "viewer/raycast/ray_caster.h"

namespace kerf {

/// Part of a picture of the workpiece: the pixels that differ from those of the picture before it.
struct RayPicture {
  Projection projection;  ///< As it was asked for.
  /// Of the whole picture: that of the projection, or a whole fraction of it, rounded up, while the
  /// eye moves.
  glm::ivec2 size_px{1};
  /// The rectangle [low, high) that is here, from the upper left corner, in pixels of this picture.
  glm::ivec2 low_px{0}, high_px{0};
  bool has_workpiece = false;        ///< there was one
  bool is_whole = false;             ///< nothing of the pictures before it is needed
  std::vector<std::uint8_t> rgba;    ///< rows from the top; alpha is 255
  std::vector<float> window_depths;  ///< 1 where there is no workpiece
};

/// Casts the workpiece whenever it or the eye has changed. Who asks never waits for rays: what was
/// asked for last is drawn next, what came between is skipped, and pictures that nobody has taken
/// grow together.
///
///     set_workpiece(), look_from() --> [job] --> thread: RayCaster --> [picture] --> take()
///
/// While the eye moves, and a picture of full size would take more than kMoving_ms (by what the
/// pictures before it took), a coarser one is made: every second, fourth or eighth pixel each way.
/// The full one follows when the eye has stood still for kStill_ms.
class RayWorker {
 public:
  static constexpr double kMoving_ms = 25.0;
  static constexpr int kStill_ms = 120;

  /// `on_picture` is called in the thread of the worker when there is one to be taken; may be
  /// empty.
  RayWorker(int threads, std::function<void()> on_picture);
  RayWorker(const RayWorker&) = delete;
  RayWorker& operator=(const RayWorker&) = delete;
  /// Waits for the picture that is being made: some hundred milliseconds at most.
  ~RayWorker() = default;

  /// Null: none. All other members likewise: microseconds.
  void set_workpiece(std::shared_ptr<const HeightGrid> grid);
  void look_from(const Projection& projection);
  /// The next picture is whole: what was taken so far has been thrown away.
  void begin_anew();
  bool has_picture() const;
  /// What has become of the picture since the last one that was taken; null: nothing.
  std::unique_ptr<RayPicture> take();

 private:
  using Clock = std::chrono::steady_clock;
  struct Job {
    std::shared_ptr<const HeightGrid> grid;
    Projection projection;
    bool wants_whole = false;
  };

  void run(const std::stop_token& stop);
  void make(const Job& job);
  int divisor_for(glm::ivec2 size_px) const;
  void publish(const RayCounters& counters, glm::ivec2 size_px, bool is_whole);

  std::function<void()> on_picture_;
  mutable std::mutex mutex_;  // of the four below
  std::condition_variable_any asked_;
  Job job_;
  bool is_job_new_ = false;
  std::unique_ptr<RayPicture> picture_;

  // of the thread
  RayCaster caster_;
  std::shared_ptr<const HeightGrid> grid_;
  Projection projection_;
  bool has_looked_ = false;
  int divisor_ = 1;
  Clock::time_point full_at_{};  ///< the eye will have stood still
  double ns_per_pixel_ = 150.0;  ///< of the last whole picture

  std::jthread thread_;  // last: ends before what it uses
};

}  // namespace kerf
