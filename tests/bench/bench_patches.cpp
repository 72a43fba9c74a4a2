// bench_patches: what it costs to show a workpiece: dirty tiles, snapshots, patches.
//
//   bench_patches [--cells N] [--runs N]
//
// Cuts an N x N map (default 2000) with a raster of bowls, walls, slots and circles. For each level
// the time and size of all patches, their deviation from the heights (checked first), and what a
// snapshot and a question for dirty tiles cost. Then the same where the map keeps which move cut
// each cell.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/sweep_ops.h"
#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

constexpr double kCell_mm = 0.05;

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_patches: {}\n", why);
  std::exit(2);
}

double now_us() {
  return std::chrono::duration<double, std::micro>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

double percentile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

CutMove line(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

std::unique_ptr<ZMap> make_part(int cells, bool keep_cut_ids) {
  const double side = cells * kCell_mm;
  ZMapOptions options;
  options.blank = *parse_blank(fmt::format("box:0,0,-20:{},{},0", side, side));
  options.cell_mm = kCell_mm;
  Result<std::unique_ptr<ZMap>> map = ZMap::create(options);
  if (!map) fail(map.error());
  (*map)->keep_cut_ids(keep_cut_ids);
  return std::move(*map);
}

/// Waves by a ball in one half, pockets, slots and rings by a flat cutter in the other.
void cut_part(ZMap& map) {
  const double side = map.bounds_mm().max.x;
  std::vector<CutReport> reports;
  std::vector<CutMove> moves;
  for (double y = 1; y < 0.5 * side; y += 0.4) {
    Vec3 at(0, y, -2);
    for (double x = 0.5; x < side; x += 0.5) {
      const Vec3 to(x, y, -2 + std::sin(0.3 * x) * std::cos(0.2 * y));
      moves.push_back(line(at, to));
      moves.back().id = moves.size();
      at = to;
    }
  }
  map.cut(*parse_shape("ball:6"), moves, reports);
  moves.clear();
  for (int n = 0; n < 12; ++n) {
    const double x = side * (n + 0.7) / 13, y = side * (0.6 + 0.3 * (n % 3) / 3);
    moves.push_back(line(Vec3(x, y, -1 - n), Vec3(x + 4, y + 7, -1 - n)));
    CutMove ring = line(Vec3(x + 5, y, -3), Vec3(x + 5, y, -3));
    ring.arc = CutArc{Vec3(x, y, -3), Vec3(0, 0, 1), 2 * kPi};
    moves.push_back(ring);
  }
  map.cut(*parse_shape("flat:3"), moves, reports);
  map.finish(reports);
}

/// Distances between the patches' tops and the heights at cell centres, mm: those of the two
/// triangles about each cell of level 0.
std::vector<double> deviations_mm(const ZMap& map) {
  std::vector<double> found;
  const double cell = map.cell_mm();
  for (std::uint32_t tile = 0; tile < map.tile_count(); tile += 7) {
    const MeshPatch patch = map.patch(tile, 0);
    const auto indices = patch.surface_indices();
    for (std::size_t n = 0; n < indices.size(); n += 3) {
      const Vec3 a(patch.vertices[indices[n]].position_mm);
      const Vec3 b(patch.vertices[indices[n + 1]].position_mm);
      const Vec3 c(patch.vertices[indices[n + 2]].position_mm);
      const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
      const double off_cells = area / (cell * cell) - 1;
      if (std::abs(off_cells) > 1e-3) continue;  // a wall, a fan's, or moved to a wall's course
      // The longest edge is the cell's diagonal; its middle is over the cell's centre.
      const auto xy = [](const Vec3& p, const Vec3& q) { return std::hypot(p.x - q.x, p.y - q.y); };
      const double ab = xy(a, b), bc = xy(b, c), ca = xy(c, a);
      const Vec3 middle = 0.5 * (ab > std::max(bc, ca)   ? a + b
                                 : bc > std::max(ab, ca) ? b + c
                                                         : c + a);
      const int i = static_cast<int>((middle.x - map.bounds_mm().min.x) / cell);
      const int j = static_cast<int>((middle.y - map.bounds_mm().min.y) / cell);
      found.push_back(std::abs(middle.z - static_cast<double>(map.height_mm(i, j))));
    }
  }
  return found;
}

void time_patches(const ZMap& map, int runs) {
  for (int level = 0; level < StockModel::kPatchLevels; ++level) {
    std::vector<double> best(map.tile_count(), 1e9);
    std::size_t triangles = 0, bytes = 0;
    for (int run = 0; run < runs; ++run) {
      triangles = bytes = 0;
      for (std::uint32_t tile = 0; tile < map.tile_count(); ++tile) {
        const double start = now_us();
        const MeshPatch patch = map.patch(tile, level);
        best[tile] = std::min(best[tile], now_us() - start);
        triangles += patch.surface_indices().size() / 3;
        bytes += patch.bytes();
      }
    }
    fmt::print(
        "  level {}  {:6.1f} us a tile median, {:6.1f} p90, {:6.1f} worst (best of {} each)   "
        "{:8} triangles, {:5.1f} MB\n",
        level, percentile(best, 0.5), percentile(best, 0.9), percentile(best, 1), runs, triangles,
        static_cast<double>(bytes) / 1e6);
  }
}

void time_sharing(ZMap& map, int runs) {
  const auto cutter = parse_shape("ball:6");
  std::vector<CutReport> reports;
  std::vector<double> snapshot, drop, dirty, cut_shared, cut_alone;
  map.take_dirty_tiles();
  const double side = map.bounds_mm().max.x;
  for (int run = 0; run < 20 * runs; ++run) {
    // A move of 30 mm, a little deeper each time.
    const double y = side * (0.2 + 0.6 * (run % 17) / 17), z = -4 - 0.01 * run;
    const CutMove there = line(Vec3(0.3 * side, y, z), Vec3(0.3 * side + 30, y, z));
    const CutMove back = line(there.to_mm - Vec3(0, 0, 0.005), there.from_mm - Vec3(0, 0, 0.005));
    double start = now_us();
    std::unique_ptr<StockModel> frame = map.snapshot();
    snapshot.push_back(now_us() - start);
    start = now_us();
    map.cut(*cutter, std::span(&there, 1), reports);
    map.finish(reports);
    cut_shared.push_back(now_us() - start);
    start = now_us();
    map.cut(*cutter, std::span(&back, 1), reports);
    map.finish(reports);
    cut_alone.push_back(now_us() - start);
    start = now_us();
    const std::size_t count = map.take_dirty_tiles().size();
    dirty.push_back((now_us() - start) / static_cast<double>(std::max<std::size_t>(1, count)));
    start = now_us();
    frame.reset();
    drop.push_back(now_us() - start);
  }
  fmt::print("  snapshot {:.1f} us median, {:.1f} p99; dropped in {:.1f} us\n",
             percentile(snapshot, 0.5), percentile(snapshot, 0.99), percentile(drop, 0.5));
  fmt::print("  a 30 mm move {:.0f} us, the first after a snapshot {:.0f} us\n",
             percentile(cut_alone, 0.5), percentile(cut_shared, 0.5));
  fmt::print("  dirty tiles {:.2f} us a dirty tile\n", percentile(dirty, 0.5));
}

int run(int argc, char** argv) {
  int cells = 2000, runs = 5;
  for (int i = 1; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 >= argc) fail(key + " needs a value");
    const int value = std::atoi(argv[i + 1]);
    if (key == "--cells" && value >= 200)
      cells = value;
    else if (key == "--runs" && value >= 1)
      runs = value;
    else
      fail("--cells (at least 200) and --runs (at least 1) are all there is");
  }
  for (const bool keep_cut_ids : {false, true}) {
    const std::unique_ptr<ZMap> map = make_part(cells, keep_cut_ids);
    cut_part(*map);
    fmt::print("{} x {} cells, {} tiles of {} x {}{}\n", map->nx(), map->ny(), map->tile_count(),
               kTileCells, kTileCells, keep_cut_ids ? ", with cut ids" : "");
    const std::vector<double> off = deviations_mm(*map);
    if (off.empty()) fail("no triangles");
    fmt::print("  off the heights at cell centres: median {:.2g} mm, p99 {:.2g}, worst {:.2g}\n",
               percentile(off, 0.5), percentile(off, 0.99), percentile(off, 1));
    if (percentile(off, 0.99) > 0.5 * map->cell_mm()) fail("the patches are off");
    time_patches(*map, runs);
    time_sharing(*map, runs);
  }
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) { return kerf::run(argc, argv); }
