// bench_blank_mesh: what it costs to begin with a mesh.
//
//   bench_blank_mesh [RUNS]
//
// A ball of 1,000,000 triangles, 80 mm wide: looked over, grown by 2 mm, and made a blank of
// columns with gaps in 0.1 mm cells, and of 0.25 mm in space; as it is and grown. Its upper half is
// made heights in 0.1 mm cells. First each volume is held against the ball's, and 20,000 points of
// the octree against the sphere. Then best of RUNS (3) on one thread, and the memory it took.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>

#include "mesh/mesh_body.h"
#include "mesh/mesh_offset.h"
#include "stock/octree/octree.h"
#include "stock/zmap/mmap/mmap.h"
#include "stock/zmap/zmap.h"
#include "tests/bench/process_usage.h"
#include "tests/twin/compare/meshes.h"

namespace kerf {
namespace {

constexpr double kRadius_mm = 40, kAllowance_mm = 2, kCell_mm = 0.1, kOctreeCell_mm = 0.25;

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_blank_mesh: {}\n", why);
  std::exit(2);
}

double best_s(int runs, const std::function<void()>& work) {
  double best = 1e300;
  for (int n = 0; n < runs; ++n) {
    const double start = cpu_s();
    work();
    best = std::min(best, cpu_s() - start);
  }
  return best;
}

Blank blank_of(const std::shared_ptr<const MeshBody>& body) {
  Blank blank;
  blank.mesh.emplace();
  blank.mesh->body = body;
  return blank;
}

template <class Model, class Options>
std::unique_ptr<Model> made(const std::shared_ptr<const MeshBody>& body, double cell_mm) {
  Options options;
  options.blank = blank_of(body);
  options.cell_mm = cell_mm;
  auto model = Model::create(options);
  if (!model) fail(model.error());
  return std::move(model.value());
}

void check_volume(const StockModel& stock, double volume_mm3) {
  if (std::abs(stock.remaining_mm3() - volume_mm3) > 1e-3 * volume_mm3)
    fail(fmt::format("{} holds {} mm3, {} are right", stock.name(), stock.remaining_mm3(),
                     volume_mm3));
}

/// Chords of the ball lie 0.0002 mm below it.
void check_points(const Octree& tree, double radius_mm) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-radius_mm, radius_mm);
  for (int n = 0; n < 20'000; ++n) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = at(random);
    const double beyond_mm = glm::length(p) - radius_mm;
    if (std::abs(beyond_mm) > 0.02 && tree.solid_at(p, 0) != (beyond_mm < 0))
      fail(fmt::format("X{} Y{} Z{} is told wrongly", p.x, p.y, p.z));
  }
}

void measure(int runs, const std::shared_ptr<const MeshBody>& body, double radius_mm,
             const char* name) {
  const double ball = 4.0 / 3 * kPi * radius_mm * radius_mm * radius_mm;
  check_volume(*made<MMap, ZMapOptions>(body, kCell_mm), ball);
  const auto tree = made<Octree, OctreeOptions>(body, kOctreeCell_mm);
  check_volume(*tree, ball);
  check_points(*tree, radius_mm);
  const double columns_s = best_s(runs, [&] { made<MMap, ZMapOptions>(body, kCell_mm); });
  const double space_s = best_s(runs, [&] { made<Octree, OctreeOptions>(body, kOctreeCell_mm); });
  fmt::print("{}: {} triangles: checked; mmap {:.2f} s, octree {:.2f} s\n", name,
             body->mesh.triangles.size(), columns_s, space_s);
}

/// From a flat floor up, a fifth of its rings on the floor.
void measure_heights(int runs) {
  const auto half = [](double v) { return kPi / 2 * (v - 0.2) / 0.8; };
  const TriangleMesh mesh = test::turned_mesh(
      1000, 500, [&](double v) { return kRadius_mm * (v < 0.2 ? v / 0.2 : std::cos(half(v))); },
      [&](double v) { return v <= 0.2 ? 0 : kRadius_mm * std::sin(half(v)); });
  Result<MeshBody> body = mesh_body(mesh, "dome");
  if (!body) fail(body.error());
  const auto dome = std::make_shared<const MeshBody>(std::move(body.value()));
  check_volume(*made<ZMap, ZMapOptions>(dome, kCell_mm),
               2.0 / 3 * kPi * kRadius_mm * kRadius_mm * kRadius_mm);
  const double heights_s = best_s(runs, [&] { made<ZMap, ZMapOptions>(dome, kCell_mm); });
  fmt::print("its upper half: {} triangles: checked; zmap {:.2f} s\n", mesh.triangles.size(),
             heights_s);
}

int run(int runs) {
  const TriangleMesh mesh = test::sphere_mesh(kRadius_mm, 1000);
  Result<MeshBody> body = mesh_body(mesh, "ball");
  if (!body) fail(body.error());
  const auto ball = std::make_shared<const MeshBody>(std::move(body.value()));
  const double look_s = best_s(runs, [&] { (void)mesh_body(mesh, "ball"); });
  Result<MeshBody> larger = grown(*ball, kAllowance_mm, "ball");
  if (!larger) fail(larger.error());
  const double grow_s = best_s(runs, [&] { (void)grown(*ball, kAllowance_mm, "ball"); });
  fmt::print("{} triangles: looked over in {:.2f} s, grown in {:.2f} s\n", mesh.triangles.size(),
             look_s, grow_s);
  measure(runs, ball, kRadius_mm, "as it is");
  measure(runs, std::make_shared<const MeshBody>(std::move(larger.value())),
          kRadius_mm + kAllowance_mm, "grown");
  measure_heights(runs);
  fmt::print("seconds of processor, best of {}, one thread; {:.0f} MB at most\n", runs, peak_mb());
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  return kerf::run(std::max(1, argc > 1 ? std::atoi(argv[1]) : 3));
}
