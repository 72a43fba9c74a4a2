// bench_proof: what it costs to hold a finished part against its design.
//
//   bench_proof [RUNS]
//
// A dome of 1,000,000 triangles against 2000 x 2000 cells, cut by a ball 10,000 moves long, a tenth
// of them 0.3 mm too high, one 0.2 mm too deep. First the deviations of 200 cells' middles are held
// against all triangles one by one, and what is told against what was planted. Then: the design
// made ready and the comparison, on one thread; best of RUNS (3), and the memory it took.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/bench/process_usage.h"
#include "tests/twin/compare/meshes.h"
#include "twin/compare/compare_stock.h"
#include "twin/process/kept_moves.h"

namespace kerf {
namespace {

constexpr double kRadius_mm = 40, kBall_mm = 3, kCell_mm = 0.025, kDepth_mm = 0.2;

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_proof: {}\n", why);
  std::exit(2);
}

struct Work {
  std::unique_ptr<ZMap> map;
  KeptMoves kept;
  std::vector<CutLabel> labels;
};

Work cut_dome() {
  Work work;
  ZMapOptions options;
  options.blank = *parse_blank("box:-25,-25,0:25,25,41");
  options.cell_mm = kCell_mm;
  Result<std::unique_ptr<ZMap>> map = ZMap::create(options);
  if (!map) fail(map.error());
  work.map = std::move(*map);
  work.map->keep_cut_ids(true);
  const Cutter ball = *parse_shape("ball:6");
  std::vector<CutMove> moves;
  for (double y = -26; y <= 26; y += 0.1) {
    for (double x = -26; x < 26; x += 2) {
      const auto tip = [&](double at) {
        const double far = kRadius_mm + kBall_mm;
        const double z = std::sqrt(far * far - at * at - y * y) - kBall_mm;
        return Vec3(at, y, z + (y > 20 ? 0.3 : 0.02));
      };
      CutMove move;
      // Chords of the dome lie below it by up to 0.012 mm.
      move.from_mm = tip(x);
      move.to_mm = tip(x + 2);
      move.id = work.labels.size();
      work.labels.push_back({1, {0, static_cast<std::uint32_t>(work.labels.size() + 1)}});
      moves.push_back(move);
    }
  }
  CutMove deep;
  deep.from_mm = {0, 0, kRadius_mm + 1};
  deep.to_mm = {0, 0, kRadius_mm - kDepth_mm};
  deep.id = work.labels.size();
  work.labels.push_back({1, {0, 999'999}});
  moves.push_back(deep);
  work.kept.add(ball, moves);
  std::vector<CutReport> reports;
  work.map->cut(ball, moves, reports);
  work.map->finish(reports);
  return work;
}

void check(const Work& work, const DesignPart& design, const Comparison& compared) {
  const std::shared_ptr<const HeightGrid> grid = work.map->height_grid();
  for (int n = 0; n < 200; ++n) {
    const int i = n * 7919 % grid->nx(), j = n * 6101 % grid->ny();
    const Vec3 p(-25 + (i + 0.5) * kCell_mm, -25 + (j + 0.5) * kCell_mm,
                 static_cast<double>(grid->height(i, j)));
    double nearest = 1e300;
    for (std::uint32_t t = 0; t < design.size(); ++t)
      nearest = std::min(nearest, nearest_on_triangle(design.corners(t), p).distance2_mm2);
    const double found = std::abs(design.distance_mm(p));
    if (std::abs(found - std::sqrt(nearest)) > 1e-9)
      fail(fmt::format("a distance is {}, by all triangles {}", found, std::sqrt(nearest)));
  }
  // The design is a dome of triangles: lower than the sphere by 0.0005 mm.
  if (compared.gouges != 1 || std::abs(compared.gouge.mm - kDepth_mm) > 0.001 ||
      compared.gouge.by.source.line != 999'999)
    fail(fmt::format("{} gouges, {} mm, line {}", compared.gouges, compared.gouge.mm,
                     compared.gouge.by.source.line));
  if (compared.excesses == 0) fail("no excess");
}

int run(int runs) {
  const TriangleMesh mesh = test::sphere_mesh(kRadius_mm, 1000);
  const Work work = cut_dome();
  const double before_mb = peak_mb();
  double ready = 1e300, compare = 1e300;
  Comparison told;
  for (int n = 0; n < runs; ++n) {
    Diagnostics diagnostics;
    const double start = cpu_s();
    const DesignPart design(mesh, "dome", diagnostics);
    const double made = cpu_s();
    told = compare_stock(*work.map, design, {0.05}, {work.labels, &work.kept});
    const double done = cpu_s();
    const double took_mb = peak_mb();
    if (n == 0) {
      check(work, design, told);
      fmt::print("{} triangles, {} cells, {} moves: checked; {:.0f} MB more, {:.0f} in all\n",
                 design.size(), work.map->cell_count(), work.kept.size(), took_mb - before_mb,
                 took_mb);
    }
    ready = std::min(ready, made - start);
    compare = std::min(compare, done - made);
  }
  fmt::print(
      "design {:.2f} s, comparison {:.2f} s, both {:.2f} s of processor (best of {}, one thread)\n",
      ready, compare, ready + compare, runs);
  fmt::print("gouge {:.4f} mm, excess {:.3f} mm3, {:.2f} % within\n", told.gouge.mm,
             told.excess_mm3, told.within_percent());
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  return kerf::run(std::max(1, argc > 1 ? std::atoi(argv[1]) : 3));
}
