// bench_planner: what the time model costs. Checks its results first, then times.
//
//   bench_planner [--motions N] [--runs N]
//
// Four kinds of path, N motions each (default 1000000): a finishing pass of 0.2 mm feeds, merged
// and not, a zigzag whose every corner is cut by an arc, and lines with arcs. Prints minimum and
// median of the runs (default 5) in CPU microseconds a motion, and the peak memory.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "interp_bridge/timing/planner.h"

namespace kerf {
namespace {

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_planner: {}\n", why);
  std::exit(2);
}

double cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

double way_mm(bool curved, const Vec3& from, const Vec3& to, const ArcGeometry& arc) {
  if (!curved) return glm::length(to - from);
  return glm::length(from - arc.center_mm) * std::abs(arc.sweep_rad);
}

struct Sum : MotionPlanSink {
  std::size_t count = 0;
  double seconds = 0;
  double path_mm = 0;
  void timed(const MotionTiming& timing) override {
    ++count;
    seconds += timing.duration_s;
  }
  void path(const PathPiece& piece) override {
    path_mm += way_mm(piece.curved, piece.from_mm, piece.to_mm, piece.arc);
  }
};

struct Workload {
  std::string name;
  double tolerance_mm = 0;
  double merge_mm = 0;
};

Motion feed_to(const Workload& work, const Vec3& from, const Vec3& to) {
  Motion m;
  m.kind = MotionKind::kFeed;
  m.feed_mm_per_min = 3000;
  m.blend_tolerance_mm = static_cast<float>(work.tolerance_mm);
  m.merge_tolerance_mm = static_cast<float>(work.merge_mm);
  m.from_mm = from;
  m.to_mm = to;
  return m;
}

/// Motion number i of an endless path of this kind.
Motion motion(const Workload& work, std::size_t i) {
  const auto at = [&](std::size_t k) -> Vec3 {
    const double t = static_cast<double>(k);
    if (work.name == "zigzag") return {t, k % 2 == 0 ? 0.0 : 5.0, 0};
    if (work.name == "lines and arcs") return {t * 2, 0, 0};
    return {0.2 * t, 0, 3 * std::sin(0.02 * t) + std::sin(0.0031 * t)};
  };
  Motion m = feed_to(work, at(i), at(i + 1));
  if (work.name == "lines and arcs" && i % 2 == 1) {
    m.kind = MotionKind::kArc;
    m.arc = {(m.from_mm + m.to_mm) / 2.0, {0, 0, 1}, i % 4 == 1 ? kPi : -kPi};
  }
  return m;
}

void check(const Workload& work) {
  constexpr std::size_t kCount = 20000;
  Sum sum;
  PlannerOptions options;
  options.with_path = true;
  TrajectoryPlanner planner(MachineLimits::small_mill(), options, sum);
  double programmed_mm = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const Motion m = motion(work, i);
    programmed_mm += way_mm(m.kind == MotionKind::kArc, m.from_mm, m.to_mm, m.arc);
    planner.push(m);
  }
  planner.finish();
  if (sum.count != kCount) fail(work.name + ": motions are missing");
  if (sum.seconds < sum.path_mm / 50.0) fail(work.name + ": faster than its feed");
  if (sum.path_mm > programmed_mm * (1 + 1e-9)) fail(work.name + ": planned longer than written");
  if (std::abs(sum.seconds - planner.clock_s()) > 1e-6) fail(work.name + ": time is lost");
}

void time(const Workload& work, std::size_t count, int runs) {
  std::vector<Motion> motions(4096);
  std::vector<double> costs;
  double seconds = 0;
  for (int run = 0; run < runs; ++run) {
    Sum sum;
    TrajectoryPlanner planner(MachineLimits::small_mill(), {}, sum);
    double cost = 0;
    for (std::size_t first = 0; first < count; first += motions.size()) {
      for (std::size_t i = 0; i < motions.size(); ++i) motions[i] = motion(work, first + i);
      const double before = cpu_s();
      for (const Motion& m : motions) planner.push(m);
      cost += cpu_s() - before;
    }
    planner.finish();
    seconds = planner.clock_s();
    costs.push_back(cost * 1e6 / static_cast<double>(sum.count));
  }
  std::sort(costs.begin(), costs.end());
  fmt::print("{:<24} {:>10.0f} s of machine time; us a motion: min {:.3f} median {:.3f}\n",
             work.name + (work.merge_mm > 0 ? " merged" : ""), seconds, costs.front(),
             costs[costs.size() / 2]);
}

std::size_t number_after(const std::string& option, int argc, char** argv, std::size_t fallback) {
  for (int i = 1; i + 1 < argc; i += 2) {
    if (option != argv[i]) continue;
    const long value = std::strtol(argv[i + 1], nullptr, 10);
    if (value < 1) fail(option + " must be 1 or more");
    return static_cast<std::size_t>(value);
  }
  return fallback;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  using namespace kerf;
  const std::size_t count = number_after("--motions", argc, argv, 1000000);
  const int runs = static_cast<int>(number_after("--runs", argc, argv, 5));
  const std::vector<Workload> workloads = {{"finish", 0.01, 0},
                                           {"finish", 0.01, 0.01},
                                           {"zigzag", 0.05, 0},
                                           {"lines and arcs", 0.05, 0}};
  for (const Workload& work : workloads) check(work);
  fmt::print("results are right; {} motions, {} runs, 1 thread, {}\n", count, runs, __VERSION__);
  for (const Workload& work : workloads) time(work, count, runs);
  fmt::print("peak memory {:.1f} MB\n", peak_mb());
  return 0;
}
