// How much faster the scene is drawn when only what a cut changed is drawn again. The pictures of
// both ways are compared first, pixel by pixel; then each frame is timed until the last pixel is
// there: taking the patches over, uploading, drawing, copying to the window.
//
//     bench_redraw [FRAMES]
//
// Prints a line per size; the figures are frames a second, from the median frame.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "tests/viewer/test_scene.h"
#include "viewer/gl_context.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

constexpr glm::ivec2 kSize_px{1280, 800};
constexpr int kComparedFrames = 8;

struct Case {
  int cells_x, cells_y;
  double cutter_radius_cells;
};
/// The first is the size of the published ratio (64.2 / 10.3 frames a second).
constexpr Case kCases[] = {{300, 480, 10.0}, {2000, 2000, 40.0}};

/// The cutter goes zigzag over the workpiece, a third of its radius a frame.
std::vector<SceneUpdate> make_cuts(TestWorkpiece* workpiece, double radius, int frames) {
  std::vector<SceneUpdate> cuts;
  double along = 0.0;
  for (int frame = 0; frame < frames; ++frame) {
    along += radius / 3.0;
    const double length = 0.8 * workpiece->cells_x();
    const auto row = std::floor(along / length);
    const double x = 0.1 * workpiece->cells_x() + (along - row * length);
    const double y = 0.3 * workpiece->cells_y() + row * radius;
    workpiece->dent(x, y, radius, 0.5 * radius);
    Moment moment;
    moment.tool_pose = ToolPose{Vec3(x, y, -0.5 * radius)};
    SceneUpdate update;
    update.patches = workpiece->take_patches();
    update.moment = std::make_shared<const Moment>(std::move(moment));
    cuts.push_back(std::move(update));
  }
  return cuts;
}

/// Draws and waits for the last pixel.
double draw_ms(SceneRenderer* renderer, const SceneUpdate& update, const Projection& projection,
               const DrawOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  renderer->apply(update);
  if (const Done done = renderer->draw(projection, options); !done) {
    fmt::print(stderr, "bench_redraw: {}\n", done.error());
    std::exit(4);
  }
  renderer->finish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

double percentile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

int run(const Case& size, int frames) {
  TestWorkpiece workpiece(size.cells_x, size.cells_y);
  SceneUpdate first;
  first.setup = workpiece.setup();
  first.patches = workpiece.take_patches();
  first.tool_shape = test_tool(static_cast<float>(size.cutter_radius_cells));
  const std::vector<SceneUpdate> cuts = make_cuts(&workpiece, size.cutter_radius_cells, frames);

  DrawOptions local, full;
  local.upload_bytes_per_frame = full.upload_bytes_per_frame = std::size_t{1} << 40;
  full.is_local = false;
  Result<SceneRenderer> by_part = SceneRenderer::create();
  Result<SceneRenderer> whole = SceneRenderer::create();
  if (!by_part || !whole) return 4;
  by_part->apply(first);
  whole->apply(first);
  OrbitCamera camera;
  camera.fit(by_part->fit_box(), kSize_px);
  const Projection projection = camera.projection(by_part->depth_box(), kSize_px);
  draw_ms(&*by_part, {}, projection, local);
  draw_ms(&*whole, {}, projection, full);
  by_part->reset_counters();

  std::vector<double> local_ms, full_ms;
  for (int frame = 0; frame < frames; ++frame) {
    const SceneUpdate& cut = cuts[static_cast<std::size_t>(frame)];
    local_ms.push_back(draw_ms(&*by_part, cut, projection, local));
    full_ms.push_back(draw_ms(&*whole, cut, projection, full));
    const bool compares = frame < kComparedFrames || frame + 1 == frames;
    if (compares && by_part->read().rgb != whole->read().rgb) {
      fmt::print("{} x {} cells: the pictures of frame {} differ\n", size.cells_x, size.cells_y,
                 frame);
      return 1;
    }
  }
  const double local_fps = 1000.0 / percentile(local_ms, 0.5);
  const double full_fps = 1000.0 / percentile(full_ms, 0.5);
  const DrawCounters& counters = by_part->counters();
  fmt::print(
      "{} x {} cells, {} x {} px, {} frames, same pictures: local {:.1f} fps (best {:.2f} ms, "
      "99 % within {:.2f} ms), full {:.1f} fps (best {:.2f} ms), ratio {:.1f}; local redraws "
      "{:.2f} % of the pixels\n",
      size.cells_x, size.cells_y, kSize_px.x, kSize_px.y, frames, local_fps,
      *std::min_element(local_ms.begin(), local_ms.end()), percentile(local_ms, 0.99), full_fps,
      *std::min_element(full_ms.begin(), full_ms.end()), local_fps / full_fps,
      100.0 * static_cast<double>(counters.local.pixels) /
          (static_cast<double>(std::max<std::uint64_t>(1, counters.local.frames)) * kSize_px.x *
           kSize_px.y));
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::max(kerf::kComparedFrames, std::atoi(argv[1])) : 100;
  kerf::Result<kerf::GlContext> context = kerf::GlContext::create_offscreen();
  if (!context) {
    fmt::print(stderr, "bench_redraw: {}\n", context.error());
    return 4;
  }
  fmt::print("renderer: {}\n", kerf::SceneRenderer::gl_name());
  for (const kerf::Case& size : kerf::kCases) {
    if (const int code = kerf::run(size, frames); code != 0) return code;
  }
  return 0;
}
