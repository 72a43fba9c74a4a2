// What the surface of the octree model costs per cell with surface, on a field of many balls whose
// volume and area are known. The mesh is checked before anything is timed.
//
//     bench_dual_contour [BALLS PER SIDE]
//
// The windows of nodes are made beforehand; a call of gather copies one, which is timed by itself
// as well. Seconds are of one processor, with two threads of the clock; the best of some.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <utility>
#include <vector>

#include "stock/octree/dual_contour_mesh.h"
#include "stock/octree/dual_contour_patch.h"

namespace kerf {
namespace {

constexpr int kTileCells = 32;
constexpr int kBallTiles = 2;  // along each side of the cube that a ball lies in
constexpr double kRadius = 28.6;
constexpr int kRepeats = 3;
const Vec3 kCenter(32.17, 31.93, 32.21);

bool is_solid(const Vec3& at) { return glm::length(at - kCenter) < kRadius; }

HermiteCrossing crossing_at(Vec3 at, int axis) {
  double square = kRadius * kRadius;
  for (int other = 0; other < 3; ++other) {
    if (other != axis) square -= (at[other] - kCenter[other]) * (at[other] - kCenter[other]);
  }
  const double half = std::sqrt(std::max(square, 0.0));
  const double sign = at[axis] < kCenter[axis] ? -1.0 : 1.0;
  const double t = std::clamp(kCenter[axis] + sign * half - at[axis], 0.0, 1.0);
  at[axis] += t;
  return {static_cast<float>(t), glm::vec3(glm::normalize(at - kCenter)), 7};
}

/// The window of one of the eight tiles about a ball.
HermiteGrid make_window(const std::array<int, 3>& first, const std::array<int, 3>& nodes) {
  HermiteGrid grid;
  grid.nodes = nodes;
  const auto count = static_cast<std::size_t>(nodes[0] * nodes[1] * nodes[2]);
  grid.solid.assign(count, 0);
  for (auto& edges : grid.edges) edges.assign(count, -1);
  std::size_t n = 0;
  for (int k = 0; k < nodes[2]; ++k) {
    for (int j = 0; j < nodes[1]; ++j) {
      for (int i = 0; i < nodes[0]; ++i, ++n) {
        const Vec3 at(first[0] + i, first[1] + j, first[2] + k);
        grid.solid[n] = is_solid(at) ? 1 : 0;
        for (int axis = 0; axis < 3; ++axis) {
          Vec3 next = at;
          next[axis] += 1.0;
          if (is_solid(at) == is_solid(next)) continue;
          const auto number = static_cast<std::int32_t>(grid.crossings.size());
          grid.edges[static_cast<std::size_t>(axis)][n] = number;
          grid.crossings.push_back(crossing_at(at, axis));
        }
      }
    }
  }
  return grid;
}

class Balls {
 public:
  explicit Balls(int per_side) : per_side_(per_side) {
    const int tiles = per_side * kBallTiles;
    for (int n = 0; n < tiles * tiles * tiles; ++n)
      tiles_.push_back({n % tiles, n / tiles % tiles, n / tiles / tiles});
    const int size = kTileCells + 1 + DualContour::kLayersBelow + DualContour::kLayersAbove;
    for (int n = 0; n < kBallTiles * kBallTiles * kBallTiles; ++n) {
      std::array<int, 3> first{n % 2, n / 2 % 2, n / 4};
      for (int& f : first) f = f * kTileCells - DualContour::kLayersBelow;
      windows_[first] = make_window(first, {size, size, size});
    }
  }
  DualField field() const {
    return {Vec3(0), Vec3(1.0),
            [this](std::array<int, 3> first, const std::array<int, 3>&, HermiteGrid* grid) {
              constexpr int kPeriod = kBallTiles * kTileCells;
              for (int& f : first) {
                f += DualContour::kLayersBelow;
                f = (f % kPeriod + kPeriod) % kPeriod - DualContour::kLayersBelow;
              }
              *grid = windows_.at(first);
            }};
  }
  DualTiles tiles() const { return {kTileCells, tiles_}; }
  double count() const { return std::pow(per_side_, 3); }

 private:
  int per_side_;
  std::vector<std::array<int, 3>> tiles_;
  std::map<std::array<int, 3>, HermiteGrid> windows_;
};

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
double clock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double best_s(const std::function<void()>& work, double (*now_s)() = processor_s) {
  double best = 1e9;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const double start = now_s();
    work();
    best = std::min(best, now_s() - start);
  }
  return best;
}

/// Closed, and volume and area of balls within what chords of a cell's length miss.
bool is_right(const TriangleMesh& mesh, double balls) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  double volume = 0.0, area = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]), c(mesh.positions_mm[t[2]]);
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
    for (std::size_t n = 0; n < 3; ++n) edges.emplace_back(t[n], t[(n + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  const bool is_closed =
      std::adjacent_find(edges.begin(), edges.end()) == edges.end() &&
      std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        return std::binary_search(edges.begin(), edges.end(), std::pair(edge.second, edge.first));
      });
  const double volume_error = volume / (balls * 4.0 / 3.0 * kPi * std::pow(kRadius, 3)) - 1.0;
  const double area_error = area / (balls * 4.0 * kPi * kRadius * kRadius) - 1.0;
  fmt::print("{} triangles, {}; volume {:+.5f} %, area {:+.5f} %\n", mesh.triangles.size(),
             is_closed ? "closed" : "OPEN", 100.0 * volume_error, 100.0 * area_error);
  return is_closed && std::abs(volume_error) < 5e-4 && std::abs(area_error) < 5e-4;
}

void print(const char* what, double seconds, double cells) {
  fmt::print("{:<34} {:7.3f} s {:7.1f} ns a cell {:7.2f} M cells/s\n", what, seconds,
             1e9 * seconds / cells, 1e-6 * cells / seconds);
}

int run(int per_side) {
  const Balls balls(per_side);
  const DualField field = balls.field();
  const DualTiles tiles = balls.tiles();
  if (!is_right(mesh_dual_field(field, tiles, 0.0, 1), balls.count()) ||
      !is_right(mesh_dual_field(field, tiles, 0.01, 1), balls.count())) {
    fmt::print(stderr, "bench_dual_contour: the mesh is wrong\n");
    return 1;
  }
  DualContour contour;
  double cells = 0.0;
  const auto each_tile = [&](const auto& work) {
    return best_s([&] {
      for (const auto& tile : tiles.tiles) work(tiles.box(tile));
    });
  };
  HermiteGrid grid;
  const double gather_s = each_tile([&](const CellBox& box) {
    std::array<int, 3> first = box.first;
    for (int& f : first) f -= DualContour::kLayersBelow;
    field.gather(first, {}, &grid);
  });
  const double contour_s = each_tile([&](const CellBox& box) { contour.contour(field, box); });
  each_tile([&](const CellBox& box) {
    contour.contour(field, box);
    cells += static_cast<double>(contour.quads().size()) / kRepeats;
  });
  print("copying of windows", gather_s, cells);
  print("contour, without that", contour_s - gather_s, cells);
  for (int level = 0; level < 4; level += 3) {
    const double patch_s =
        each_tile([&](const CellBox& box) { make_dual_patch(field, box, level, true, &contour); });
    print(level == 0 ? "patches, level 0, without that" : "patches, level 3, without that",
          patch_s - gather_s, cells);
  }
  for (const int threads : {1, 2}) {
    const double whole_s = best_s([&] { mesh_dual_field(field, tiles, 0.0, threads); },
                                  threads == 1 ? processor_s : clock_s);
    print(threads == 1 ? "mesh" : "mesh, 2 threads", whole_s, cells);
  }
  print("mesh, 0.01 cells tolerance", best_s([&] { mesh_dual_field(field, tiles, 0.01, 1); }),
        cells);
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  const int per_side = argc > 1 ? std::atoi(argv[1]) : 4;
  if (argc > 2 || per_side < 1) {
    fmt::print(stderr, "usage: bench_dual_contour [BALLS PER SIDE]\n");
    return 2;
  }
  return kerf::run(per_side);
}
