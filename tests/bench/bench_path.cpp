// bench_path: a tool path of millions of vertices in the window's renderer, offscreen.
//
//   bench_path [VERTICES]
//
// Rows of finishing over a wavy surface, 10 million vertices unless told otherwise, handed over
// chunk by chunk as the player's view does and uploaded within the usual budget of a frame. Prints
// the frames until all of it is shown and how long they took, then the frames of an eye that turns,
// of a tool that passes along the path, and of an eye that turns close to it, and as in the window,
// with fewer pixels while it does; and the memory that came to the process with the path, beside
// what is on the card (with a software renderer that is memory of the process as well). Ends with 1
// if a frame of the tool was not local.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <vector>

#include "viewer/gl_context.h"
#include "viewer/orbit_camera.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

constexpr glm::ivec2 kSize_px{1280, 800};
constexpr std::size_t kRow = 5000;  // vertices
constexpr double kSide_mm = 200.0;
/// As many as TrackPath hands over at once.
constexpr std::size_t kChunksAtOnce = 16;

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_path: {}\n", why);
  std::exit(2);
}

double in_use_mb() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1e6;
}

PathVertex vertex_at(std::size_t i, std::size_t count) {
  const double rows = static_cast<double>(count) / static_cast<double>(kRow);
  const std::size_t row = i / kRow;
  const double along = static_cast<double>(i % kRow) / static_cast<double>(kRow);
  const double x = kSide_mm * (row % 2 == 0 ? along : 1 - along);
  const double y = kSide_mm * static_cast<double>(row) / rows;
  return PathVertex{glm::vec3(x, y, -6 + 3 * std::sin(x / 9) * std::cos(y / 7)), PathKind::kFeed};
}

std::shared_ptr<const PathChunk> chunk_of(std::size_t index, std::size_t count) {
  auto chunk = std::make_shared<PathChunk>();
  chunk->index = static_cast<std::uint32_t>(index);
  const std::size_t first = index * kPathChunkSegments;
  const std::size_t end = std::min(first + kPathChunkSegments + 1, count);
  chunk->vertices.reserve(end - first);
  for (std::size_t i = first; i < end; ++i) chunk->vertices.push_back(vertex_at(i, count));
  return chunk;
}

/// Of all threads of this process: with a software renderer what a frame costs, whatever else the
/// computer does.
double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string spread(std::vector<double> ms, double processor_ms) {
  std::sort(ms.begin(), ms.end());
  return fmt::format(
      "{} frames, median {:.1f} ms, p99 {:.1f} ms, longest {:.1f} ms, {:.1f} ms of processor each",
      ms.size(), ms[ms.size() / 2], ms[ms.size() * 99 / 100], ms.back(),
      processor_ms / static_cast<double>(ms.size()));
}

class Bench {
 public:
  explicit Bench(std::size_t vertices)
      : vertices_(vertices), renderer_(std::move(SceneRenderer::create().value())) {
    SceneSetup setup;
    setup.bounds_mm = {Vec3(0, 0, -30), Vec3(kSide_mm, kSide_mm, 0)};
    SceneUpdate update;
    update.setup = std::make_shared<const SceneSetup>(setup);
    renderer_.apply(update);
    camera_.fit(renderer_.fit_box(), kSize_px);
    draw();
  }

  void load() {
    const double before_mb = in_use_mb();
    const std::size_t chunks = (vertices_ + kPathChunkSegments - 1) / kPathChunkSegments;
    const Clock::time_point start = Clock::now();
    const double start_ms = processor_ms();
    std::vector<double> ms;
    for (std::size_t next = 0; next < chunks || renderer_.has_waiting();) {
      SceneUpdate update;
      for (std::size_t i = 0; i < kChunksAtOnce && next < chunks; ++i) {
        update.path.push_back(chunk_of(next++, vertices_));
      }
      ms.push_back(timed([&] { renderer_.apply(update); }));
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    fmt::print("{} vertices: all shown after {:.1f} s; {}\n", vertices_, seconds,
               spread(ms, processor_ms() - start_ms));
    const double card_mb = static_cast<double>(renderer_.counters().gpu_bytes) / 1e6;
    fmt::print("memory: {:.0f} MB more in use; {:.0f} MB on the card with all layers\n",
               in_use_mb() - before_mb, card_mb);
  }

  void turn() {
    const double start_ms = processor_ms();
    std::vector<double> ms;
    for (int i = 0; i < 60; ++i) {
      ms.push_back(timed([&] { camera_.orbit({6.0f, 0.0f}, kSize_px); }));
    }
    fmt::print("the eye turns: {}\n", spread(ms, processor_ms() - start_ms));
  }

  /// False: not only what it passed was drawn.
  bool pass() {
    constexpr int kFrames = 200;
    renderer_.reset_counters();
    const double start_ms = processor_ms();
    std::vector<double> ms;
    for (int i = 0; i < kFrames; ++i) {
      Moment moment;
      moment.past_vertices = vertices_ / 2 + 100 * static_cast<std::size_t>(i);
      SceneUpdate update;
      update.moment = std::make_shared<const Moment>(moment);
      ms.push_back(timed([&] { renderer_.apply(update); }));
    }
    const DrawCounters& counters = renderer_.counters();
    fmt::print("the tool passes 100 vertices a frame: {}; {} pixels each\n",
               spread(ms, processor_ms() - start_ms),
               counters.local.pixels / std::max<std::uint64_t>(1, counters.local.frames));
    // The first one turns half of the path from future to past.
    return counters.full.frames == 0 && counters.local.frames + counters.still.frames == kFrames;
  }

  /// As in the window: fewer pixels while the eye turns, all of them when it has come to rest.
  void turn_at_pace() {
    renderer_.keep_pace();
    camera_.fit(renderer_.fit_box(), kSize_px);
    turn();
    double ms = 0.0, start_ms = 0.0;
    do {
      start_ms = processor_ms();
      ms = timed([] {});
    } while (renderer_.has_waiting());
    fmt::print("it comes to rest: {:.1f} ms, {:.1f} ms of processor\n", ms,
               processor_ms() - start_ms);
  }

  void approach() { camera_.zoom(40.0, 0.5f * glm::vec2(kSize_px), kSize_px); }

 private:
  double timed(const std::function<void()>& prepare) {
    const Clock::time_point start = Clock::now();
    prepare();
    draw();
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }
  void draw() {
    const Done done =
        renderer_.draw(camera_.projection(renderer_.depth_box(), kSize_px), DrawOptions{});
    if (!done) fail(done.error());
    renderer_.finish();
  }

  std::size_t vertices_;
  SceneRenderer renderer_;
  OrbitCamera camera_;
};

int run(std::size_t vertices) {
  const Result<GlContext> context = GlContext::create_offscreen();
  if (!context) fail(context.error());
  fmt::print("{}\n", SceneRenderer::gl_name());
  Bench bench(vertices);
  bench.load();
  bench.turn();
  const bool is_local = bench.pass();
  bench.approach();
  fmt::print("close to it, ");
  bench.turn();
  fmt::print("as in the window, ");
  bench.turn_at_pace();
  return is_local ? 0 : 1;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  constexpr std::size_t kVertices = 10'000'000;
  return kerf::run(argc > 1 ? std::max(2ul, std::strtoul(argv[1], nullptr, 10)) : kVertices);
}
