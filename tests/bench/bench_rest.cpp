// bench_rest: how long it takes to find how deep a tool comes over a design.
//
//   bench_rest [RUNS]
//
// A ball of 6 mm, a flat cutter and a bull-nosed one of 10 mm over 1000 x 1000 cells of 0.1 mm:
// waves that they reach nowhere alike, all cells asked for. First 300 cells are held against every
// place of the ball. Then processor time, one thread; best of RUNS (3).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "tests/bench/process_usage.h"
#include "twin/compare/tool_reach.h"

namespace kerf {
namespace {

constexpr int kCells = 1000;
constexpr double kCell_mm = 0.1;

double height(double x, double y) {
  return 3 * std::sin(0.35 * x) * std::cos(0.3 * y) + 0.2 * std::sin(3 * x + y);
}

/// What the places about a cell leave there; each by all cells under the tool.
double lowest_at(const std::vector<float>& design, const Cutter& cutter, int ci, int cj) {
  const int reach = static_cast<int>(cutter.radius_mm() / kCell_mm) + 1;
  const double radius = cutter.radius_mm() - 1e-7;
  double lowest = 1e300;
  for (int half_y = 2 * (cj - reach); half_y <= 2 * (cj + reach); ++half_y) {
    for (int half_x = 2 * (ci - reach); half_x <= 2 * (ci + reach); ++half_x) {
      const double px = half_x / 2.0, py = half_y / 2.0;
      const double beside = std::hypot(px - ci, py - cj) * kCell_mm;
      if (beside > radius) continue;
      double tip = -1e300;
      for (int j = std::max(0, half_y / 2 - reach);
           j <= std::min(kCells - 1, half_y / 2 + reach + 1); ++j) {
        for (int i = std::max(0, half_x / 2 - reach);
             i <= std::min(kCells - 1, half_x / 2 + reach + 1); ++i) {
          const double r = std::hypot(i - px, j - py) * kCell_mm;
          if (r > radius) continue;
          const auto at = static_cast<std::size_t>(j) * kCells + static_cast<std::size_t>(i);
          tip = std::max(tip, static_cast<double>(design[at]) - cutter.height_mm(r));
        }
      }
      lowest = std::min(lowest, tip + cutter.height_mm(beside));
    }
  }
  return lowest;
}

int run(int runs) {
  std::vector<float> design;
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i)
      design.push_back(static_cast<float>(height((i + 0.5) * kCell_mm, (j + 0.5) * kCell_mm)));
  const ToolReach reach(kCells, kCells, Vec2(kCell_mm), design);
  const std::vector<std::uint8_t> all(design.size(), 1);
  const Cutter small = *parse_shape("ball:2");
  const std::vector<float> checked = reach.lowest_mm(small, all, 0);
  for (int n = 0; n < 300; ++n) {
    const int i = 100 + n * 7919 % 800, j = 100 + n * 6101 % 800;
    const double expected = lowest_at(design, small, i, j);
    const double found = static_cast<double>(
        checked[static_cast<std::size_t>(j) * kCells + static_cast<std::size_t>(i)]);
    if (std::abs(found - expected) > 1e-5) {
      fmt::print(stderr, "bench_rest: cell {} {} is {}, by all places {}\n", i, j, found, expected);
      return 2;
    }
  }
  for (const std::string shape : {"ball:6", "flat:10", "bull:10:2"}) {
    double best = 1e300;
    for (int n = 0; n < runs; ++n) {
      const double start = cpu_s();
      reach.lowest_mm(*parse_shape(shape), all, 0.001f);
      best = std::min(best, cpu_s() - start);
    }
    fmt::print("{}: {:.2f} s of processor (best of {}, one thread)\n", shape, best, runs);
  }
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  return kerf::run(std::max(1, argc > 1 ? std::atoi(argv[1]) : 3));
}
