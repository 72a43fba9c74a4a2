// bench_compare: what it costs to compare a workpiece with a design part.
//
//   bench_compare [RUNS]
//
// A sphere of 100,000 triangles: making the part, and distances of 1,000,000 points one beside the
// other, on the surface, 1 mm and 5 mm off it (checked against the closed form first). Then a dome
// of 1000 x 1000 cells cut by a ball: per tile, the patch alone and with its deviation.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/twin/compare/meshes.h"
#include "twin/compare/patch_deviation.h"

namespace kerf {
namespace {

constexpr double kRadius_mm = 30;
constexpr int kPoints = 1'000'000;

double now_us() {
  return std::chrono::duration<double, std::micro>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_compare: {}\n", why);
  std::exit(2);
}

void time_distances(const DesignPart& part, double off_mm, int runs) {
  double best = 1e30, worst_mm = 0;
  for (int run = 0; run < runs; ++run) {
    DesignProbe probe(part);
    const double start = now_us();
    for (int n = 0; n < kPoints; ++n) {
      // Rows of points about 0.1 mm apart, as the vertices of a patch are.
      const double u = 0.0033 * (n % 400), v = 0.5 + 0.0008 * (n / 400);
      const Vec3 way(std::cos(u) * std::sin(v), std::sin(u) * std::sin(v), std::cos(v));
      const double found = probe.distance_mm((kRadius_mm + off_mm) * way, 10);
      worst_mm = std::max(worst_mm, std::abs(found - off_mm));
    }
    best = std::min(best, now_us() - start);
  }
  if (worst_mm > 0.05) fail(fmt::format("a distance is wrong by {} mm", worst_mm));
  fmt::print("  {:4.1f} mm off  {:6.3f} us a point   (worst error {:.4f} mm)\n", off_mm,
             best / kPoints, worst_mm);
}

void time_tiles(const DesignPart& part, int runs) {
  ZMapOptions options;
  options.blank = *parse_blank("box:-25,-25,0:25,25,31");
  options.cell_mm = 0.05;
  Result<std::unique_ptr<ZMap>> map = ZMap::create(options);
  if (!map) fail(map.error());
  std::vector<CutMove> moves;
  std::vector<CutReport> reports;
  // The middle of a ball of 6 mm, kept at its radius from the dome.
  for (double y = -25; y < 25; y += 0.5) {
    for (double x = -25; x < 25; x += 0.5) {
      const auto tip = [&](double at) {
        const double far = kRadius_mm + 3, rest = far * far - at * at - y * y;
        return Vec3(at, y, (rest > 9 ? std::sqrt(rest) : 3) - 3);
      };
      CutMove move;
      move.from_mm = tip(x);
      move.to_mm = tip(x + 0.5);
      moves.push_back(move);
    }
  }
  (*map)->cut(*parse_shape("ball:6"), moves, reports);
  (*map)->finish(reports);
  double plain_us = 1e30, compared_us = 1e30, slowest_us = 0;
  std::size_t before = 0, after = 0;
  for (int run = 0; run < runs; ++run) {
    double plain = 0, compared = 0, slowest = 0;
    before = after = 0;
    for (std::uint32_t tile = 0; tile < (*map)->tile_count(); ++tile) {
      const double start = now_us();
      MeshPatch patch = (*map)->patch(tile, 0);
      const double made = now_us();
      before += patch.vertices.size();
      add_deviation(part, {options.cell_mm, 0.05}, &patch);
      const double done = now_us();
      after += patch.vertices.size();
      plain += made - start;
      compared += done - made;
      slowest = std::max(slowest, done - made);
    }
    if (compared < compared_us) slowest_us = slowest;
    plain_us = std::min(plain_us, plain);
    compared_us = std::min(compared_us, compared);
  }
  const auto tiles = static_cast<double>((*map)->tile_count());
  fmt::print(
      "  {} tiles: patch {:.0f} us, deviation {:.0f} us a tile (slowest {:.0f}); {:.3f} us a "
      "vertex; {} vertices, {} before\n",
      tiles, plain_us / tiles, compared_us / tiles, slowest_us,
      compared_us / static_cast<double>(after), after, before);
}

int run(int runs) {
  const TriangleMesh mesh = test::sphere_mesh(kRadius_mm, 316);
  Diagnostics diagnostics;
  double making = 1e30;
  for (int n = 0; n < runs; ++n) {
    const double start = now_us();
    const DesignPart part(mesh, "sphere", diagnostics);
    making = std::min(making, now_us() - start);
  }
  if (!diagnostics.empty()) fail(to_string(diagnostics.front()));
  const DesignPart part(mesh, "sphere", diagnostics);
  fmt::print("{} triangles, made in {:.1f} ms; best of {} each\n", part.size(), making / 1000,
             runs);
  for (const double off_mm : {0.0, 0.05, -1.0, 1.0, 5.0}) time_distances(part, off_mm, runs);
  time_tiles(part, runs);
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 5;
  return kerf::run(std::max(1, runs));
}
