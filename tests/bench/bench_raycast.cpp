// bench_raycast: what it costs to draw a workpiece by rays.
//
//   bench_raycast [--cells N] [--moves N] [--png FILE]
//
// Cuts an N x N map (default 2000), checks that the local picture after each move is that of a full
// cast bit for bit, then times: taking the workpiece over, full pictures of 1280 x 800 pixels from
// several views, and the update after a move.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "viewer/raycast/height_picture.h"
#include "viewer/raycast/ray_caster.h"

namespace kerf {
namespace {

constexpr double kCell_mm = 0.05;
constexpr glm::ivec2 kSize_px{1280, 800};
constexpr int kRuns = 7;

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_raycast: {}\n", why);
  std::exit(2);
}

double now_ms() {
  return std::chrono::duration<double, std::milli>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// What one thing took, several times: by the clock, and of processor time of all threads, which
/// says more where other programs run.
struct Times {
  std::vector<double> wall_ms, cpu_ms;
  template <class Work>
  void take(const Work& work) {
    const double wall = now_ms();
    const std::clock_t cpu = std::clock();
    work();
    cpu_ms.push_back(1000.0 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
    wall_ms.push_back(now_ms() - wall);
  }
  std::string summary() {
    std::sort(wall_ms.begin(), wall_ms.end());
    std::sort(cpu_ms.begin(), cpu_ms.end());
    return fmt::format("min {:.2f} median {:.2f} ms, cpu min {:.2f} median {:.2f} ms",
                       wall_ms.front(), wall_ms[wall_ms.size() / 2], cpu_ms.front(),
                       cpu_ms[cpu_ms.size() / 2]);
  }
};

CutMove line(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

void cut(ZMap& map, const char* shape, const std::vector<CutMove>& moves) {
  std::vector<CutReport> reports;
  map.cut(*parse_shape(shape), moves, reports);
  map.finish(reports);
}

/// Waves by a ball in one half, pockets, slots and rings by a flat cutter in the other.
void cut_part(ZMap& map) {
  const double side = map.bounds_mm().max.x;
  std::vector<CutMove> waves, slots;
  for (double y = 1; y < 0.5 * side; y += 0.4) {
    Vec3 at(0, y, -2);
    for (double x = 0.5; x < side; x += 0.5) {
      const Vec3 to(x, y, -2 + std::sin(0.3 * x) * std::cos(0.2 * y));
      waves.push_back(line(at, to));
      at = to;
    }
  }
  for (int n = 0; n < 12; ++n) {
    const double x = side * (n + 0.7) / 13, y = side * (0.6 + 0.3 * (n % 3) / 3);
    slots.push_back(line(Vec3(x, y, -1 - n), Vec3(x + 4, y + 7, -1 - n)));
    CutMove ring = line(Vec3(x + 5, y, -3), Vec3(x + 5, y, -3));
    ring.arc = CutArc{Vec3(x, y, -3), Vec3(0, 0, 1), 2 * kPi};
    slots.push_back(ring);
  }
  cut(map, "ball:6", waves);
  cut(map, "flat:3", slots);
}

Projection view_of(const Box& box, StandardView standard, bool is_perspective) {
  OrbitCamera camera;
  camera.set_perspective(is_perspective);
  camera.look_from(standard);
  camera.fit(box, kSize_px);
  return camera.projection(box, kSize_px);
}

std::shared_ptr<const ToolShape> tool_shape() {
  ToolShape shape;
  shape.cutter = {{5.0f, 0.0f}, {5.0f, 25.0f}};
  shape.shank = {{5.0f, 25.0f}, {5.0f, 40.0f}};
  shape.holder = {{10.0f, 40.0f}, {20.0f, 50.0f}, {20.0f, 70.0f}};
  return std::make_shared<const ToolShape>(std::move(shape));
}

/// Moves of a 10 mm cutter, half a millimetre to five long.
void time_moves(ZMap& map, RayCaster& local, int moves) {
  const Projection view = view_of(map.bounds_mm(), StandardView::kIsometric, true);
  RayCaster full;
  local.set_tool_shape(tool_shape());
  full.set_tool_shape(tool_shape());
  full.set_workpiece(map.height_grid());
  local.draw(view);
  const double side = map.bounds_mm().max.x;
  for (const double length : {0.5, 1.0, 5.0}) {
    Times took;
    std::size_t cast = 0, copied = 0;
    Vec3 at(0.3 * side, 0.3 * side, -1.5 - 0.3 * length);
    for (int n = 0; n < moves; ++n) {
      const double turn = 0.15 * n;
      const Vec3 to = at + length * Vec3(std::cos(turn), std::sin(turn), -0.005);
      cut(map, "flat:10", {line(at, to)});
      at = to;
      const std::unique_ptr<StockModel> frame = map.snapshot();
      RayCounters counters;
      took.take([&] {
        local.set_workpiece(frame->height_grid());
        local.set_tool_pose(ToolPose{at});
        counters = local.draw(view);
      });
      cast += counters.cast_px;
      copied += counters.copied_px;
      if (n % 8 != 0 && n + 1 != moves) continue;
      full.set_workpiece(frame->height_grid());
      full.set_tool_pose(ToolPose{at});
      full.draw(view, false);
      if (full.picture().rgb != local.picture().rgb) fail("the local picture is not the full one");
    }
    fmt::print("moves of {:.1f} mm, cutter of {:.0f} cells: {}, {} pixels cast, {} with the tool\n",
               length, 10 / kCell_mm, took.summary(), cast / static_cast<std::size_t>(moves),
               copied / static_cast<std::size_t>(moves));
  }
}

int run(int cells, int moves, const std::string& png) {
  const double side = cells * kCell_mm;
  ZMapOptions options;
  options.blank = *parse_blank(fmt::format("box:0,0,-20:{},{},0", side, side));
  options.cell_mm = kCell_mm;
  Result<std::unique_ptr<ZMap>> made = ZMap::create(options);
  if (!made) fail(made.error());
  ZMap& map = **made;
  cut_part(map);

  Times took;
  RayCaster caster;
  for (int n = 0; n < 3; ++n) {
    caster.set_workpiece(nullptr);
    took.take([&] { caster.set_workpiece(map.height_grid()); });
  }
  fmt::print("{0} x {0} cells taken over: {1}\n", cells, took.summary());
  struct View {
    const char* name;
    StandardView standard;
    bool is_perspective;
  };
  for (const View& one :
       {View{"isometric, perspective", StandardView::kIsometric, true},
        View{"isometric, orthographic", StandardView::kIsometric, false},
        View{"top", StandardView::kTop, true}, View{"front", StandardView::kFront, true}}) {
    const Projection view = view_of(map.bounds_mm(), one.standard, one.is_perspective);
    took = {};
    for (int n = 0; n < kRuns; ++n) took.take([&] { caster.draw(view, false); });

    const auto seen = std::count_if(caster.depths().begin(), caster.depths().end(),
                                    [](float depth) { return depth < 1.0f; });
    fmt::print("full picture {} x {}, {}: {}, {:.0f} % covered\n", kSize_px.x, kSize_px.y, one.name,
               took.summary(), 100.0 * static_cast<double>(seen) / kSize_px.x / kSize_px.y);
  }
  took = {};
  PictureOptions picture;
  picture.blank_mm = map.bounds_mm();
  for (int n = 0; n < 3; ++n)
    took.take([&] {
      if (!draw_heights(map.height_grid(), picture)) fail("no picture");
    });
  fmt::print("picture of the part, {} x {}: {}\n", picture.width_px, picture.height_px,
             took.summary());
  time_moves(map, caster, moves);
  if (png.empty()) return 0;
  const Done written = write_png(png, caster.picture());
  if (!written) fail(written.error());
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  int cells = 2000, moves = 40;
  std::string png;
  for (int n = 1; n + 1 < argc; n += 2) {
    const std::string name = argv[n];
    if (name == "--cells") {
      cells = std::atoi(argv[n + 1]);
    } else if (name == "--moves") {
      moves = std::atoi(argv[n + 1]);
    } else if (name == "--png") {
      png = argv[n + 1];
    } else {
      kerf::fail("unknown option " + name + "; there are --cells, --moves and --png");
    }
  }
  if (argc % 2 == 0) kerf::fail(std::string("a value is missing after ") + argv[argc - 1]);
  if (cells < 100 || cells > 8000 || moves < 1) kerf::fail("--cells 100 to 8000, --moves from 1");
  return kerf::run(cells, moves, png);
}
