// What the CSG view costs: the first picture of many moves, a new view of them, and one more move
// over a kept picture. The picture after single steps is compared with one drawn from the blank
// first, pixel by pixel.
//
//     bench_csg [MOVES...]
//
// Prints a line per number of moves; milliseconds until the last pixel is there, the best of some.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "viewer/csg/csg_renderer.h"
#include "viewer/gl_context.h"

namespace kerf {
namespace {

constexpr glm::ivec2 kSize_px{640, 480};
const Box kBlank_mm{Vec3(0, 0, -30), Vec3(100, 80, 0)};
constexpr int kViews = 3;
constexpr std::size_t kSteps = 20;

std::vector<ProfilePoint> ball(double radius_mm) {
  std::vector<ProfilePoint> outline;
  for (int deg = 0; deg <= 90; deg += 5) {
    const double angle = deg * kPi / 180.0;
    outline.push_back({static_cast<float>(radius_mm * std::sin(angle)),
                       static_cast<float>(radius_mm * (1.0 - std::cos(angle)))});
  }
  return outline;
}

/// Roughing in levels with a flat cutter, then a ball over waves; short moves as CAM programs have.
std::vector<SweptMove> program(std::size_t count) {
  std::vector<SweptMove> moves;
  const auto rows = static_cast<std::size_t>(std::max(1.0, std::sqrt(static_cast<double>(count))));
  const std::size_t per_row = (count + rows - 1) / rows;
  const auto surface = [](double x, double y) {
    return -8.0 - 4.0 * std::sin(x * 0.09) * std::cos(y * 0.07);
  };
  for (std::size_t row = 0; row < rows; ++row) {
    const double y = 80.0 * (static_cast<double>(row) + 0.5) / static_cast<double>(rows);
    for (std::size_t i = 0; i < per_row && moves.size() < count; ++i) {
      const auto at = [&](std::size_t k) {
        const double x = 100.0 * static_cast<double>(k) / static_cast<double>(per_row);
        return Vec3(x, y, surface(x, y));
      };
      moves.push_back({at(i), at(i + 1), row % 4 == 0 ? 0u : 1u});
    }
  }
  return moves;
}

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

double draw_ms(CsgRenderer* renderer, const Projection& projection) {
  const auto start = std::chrono::steady_clock::now();
  if (const Done done = renderer->draw(projection); !done) {
    fmt::print(stderr, "bench_csg: {}\n", done.error());
    std::exit(4);
  }
  renderer->finish();
  return ms_since(start);
}

CsgRenderer make_renderer() {
  Result<CsgRenderer> made = CsgRenderer::create({});
  std::vector<CsgTool> tools(2);
  tools[0].shape.cutter = {{0, 0}, {5, 0}, {5, 40}};
  tools[1].shape.cutter = ball(4.0);
  tools[1].color = 0xff60a0e0;
  if (!made || !made->set_tools(tools) || !made->set_blank(box_blank(kBlank_mm))) {
    fmt::print(stderr, "bench_csg: no renderer\n");
    std::exit(4);
  }
  return std::move(*made);
}

Projection view(int turn_px, StandardView from = StandardView::kIsometric) {
  OrbitCamera camera;
  camera.look_from(from);
  camera.orbit({static_cast<float>(turn_px), 0.0f}, kSize_px);
  camera.fit(kBlank_mm, kSize_px);
  return camera.projection(kBlank_mm, kSize_px);
}

int run(std::size_t count) {
  const std::vector<SweptMove> moves = program(count);
  CsgRenderer renderer = make_renderer();
  draw_ms(&renderer, view(0));
  const auto start = std::chrono::steady_clock::now();
  renderer.append(moves);
  const double append_ms = ms_since(start);
  double view_ms = 1e9, top_ms = 1e9;
  draw_ms(&renderer, view(0));  // the first one also uploads
  for (int i = 1; i <= kViews; ++i) {
    view_ms = std::min(view_ms, draw_ms(&renderer, view(20 * i)));
  }
  const CsgCounters turned = renderer.counters();
  for (int i = 1; i <= kViews; ++i) {
    top_ms = std::min(top_ms, draw_ms(&renderer, view(20 * i, StandardView::kTop)));
  }

  // The last moves one by one, over the kept picture of all before.
  const std::size_t steps = std::min(kSteps, count);
  CsgRenderer stepped = make_renderer();
  const std::span<const SweptMove> all(moves);
  stepped.append(all.first(count - steps));
  draw_ms(&stepped, view(0));
  std::vector<double> step_ms;
  std::size_t again = 0;
  for (std::size_t i = count - steps; i < count; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    stepped.append(all.subspan(i, 1));
    draw_ms(&stepped, view(0));
    step_ms.push_back(ms_since(begin));
    again += stepped.counters().subtractions;
  }
  draw_ms(&renderer, view(0));
  if (renderer.read_depth().depths != stepped.read_depth().depths) {
    fmt::print("{} moves: the picture made in steps differs\n", count);
    return 1;
  }
  std::sort(step_ms.begin(), step_ms.end());
  fmt::print(
      "{} moves, {} solids, {} triangles, {:.1f} MB: append {:.1f} ms, new view {:.1f} ms ({} "
      "sweeps, {} batches, {} subtractions), from above {:.1f} ms, one more move median {:.2f} ms "
      "(worst {:.2f}, {:.1f} subtractions)\n",
      count, turned.solids, turned.triangles, static_cast<double>(turned.gpu_bytes) / 1e6,
      append_ms, view_ms, turned.sweeps, turned.batches, turned.subtractions, top_ms,
      step_ms[step_ms.size() / 2], step_ms.back(),
      static_cast<double>(again) / static_cast<double>(steps));
  if (const char* folder = std::getenv("KERF_PICTURES")) {
    if (!write_png(fmt::format("{}/csg_{}.png", folder, count), renderer.read())) return 4;
  }
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  kerf::Result<kerf::GlContext> context = kerf::GlContext::create_offscreen();
  if (!context) {
    fmt::print(stderr, "bench_csg: {}\n", context.error());
    return 4;
  }
  std::vector<std::size_t> counts;
  for (int i = 1; i < argc; ++i) counts.push_back(std::strtoul(argv[i], nullptr, 10));
  if (counts.empty()) counts = {10, 100, 1000, 10000};
  for (const std::size_t count : counts) {
    if (count == 0) continue;
    if (const int code = kerf::run(count); code != 0) return code;
  }
  return 0;
}
