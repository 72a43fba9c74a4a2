// bench_turning: how fast a turned part is cut. Checks its results first, then times.
//
//   bench_turning [--runs N]
//
// A bar of 60 x 160 mm, a nose of 0.4 mm, 100 000 moves: 4 000 of longitudinal roughing, passes
// along a wavy contour of 2 000 chords each, and the last of them, whose volume is that of the
// contour. CPU seconds, the least of N runs (default 3), what a copy costs, and peak memory. Then
// quarter circles of the same nose, each of some hundred chords; and threads: 20 passes of 40
// turns, as G76 gives them, with sections, patches and a mesh.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "stock/cutter/insert_shape.h"
#include "stock/turning/turned_part.h"

namespace kerf {
namespace {

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_turning: {}\n", why);
  std::exit(2);
}

double cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

constexpr double kNose_mm = 0.4, kRadius_mm = 30, kLength_mm = 160;
constexpr double kMean_mm = 16, kWave_mm = 2, kPeriod_mm = 40;

double contour_mm(double z) { return kMean_mm + kWave_mm * std::sin(2 * kPi * z / kPeriod_mm); }

/// The controlled point (the nose's corner at low z and x) where the nose touches the contour with
/// `stock_mm` on it.
Vec2 place_at(double z, double stock_mm) {
  const double slope = kWave_mm * 2 * kPi / kPeriod_mm * std::cos(2 * kPi * z / kPeriod_mm);
  const Vec2 normal = Vec2(-slope, 1) / std::hypot(slope, 1.0);
  return Vec2(z, contour_mm(z)) + (kNose_mm + stock_mm) * normal - Vec2(kNose_mm, kNose_mm);
}

class Program {
 public:
  void go(const Vec2& to) {
    moves.push_back({at_, to, std::nullopt, moves.size()});
    at_ = to;
  }
  std::vector<TurnMove> moves;

 private:
  Vec2 at_{5, 40};
};

Program make_program() {
  constexpr int kPasses = 1000, kChords = 2000;
  Program program;
  for (int i = 0; i < kPasses; ++i) {
    const double x = kRadius_mm - (kRadius_mm - kMean_mm - kWave_mm - 6) * (i + 1) / kPasses;
    program.go({2, x});
    program.go({-150 + 0.02 * i, x});
    program.go({-149.5 + 0.02 * i, x + 0.5});
    program.go({2, x + 0.5});
  }
  const int passes = (100'000 - static_cast<int>(program.moves.size())) / kChords;
  for (int pass = 0; pass < passes; ++pass) {
    const double stock = 5.0 * (passes - 1 - pass) / passes;
    program.go({2, 40});
    program.go(place_at(2, stock));
    for (int i = 1; i < kChords - 2; ++i)
      program.go(place_at(2 - 142.0 * i / (kChords - 3), stock));
    program.go({program.moves.back().to_mm.x, 40});
  }
  return program;
}

TurnedPart blank() { return *TurnedPart::create(bar_profile(-kLength_mm, 0, 2 * kRadius_mm)); }

/// The contour's from z = -139 to 0, by the midpoint rule.
double contour_mm3() {
  constexpr int kSteps = 1'000'000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = contour_mm(-139.0 * (i + 0.5) / kSteps);
    sum += r * r;
  }
  return kPi * sum * 139.0 / kSteps;
}

/// Of the part from z = -139 to 0.
double part_mm3(TurnedPart part) {
  const TurningTool tool(*groove_insert({60, 0, 60, 1}));
  part.cut(tool, {{-139, 80}, {-139, -1}, std::nullopt, 0});
  return part.remaining_mm3();
}

/// CPU seconds.
double run(const Program& program, const TurningTool& tool, TurnedPart& part) {
  part = blank();
  const double start = cpu_s();
  for (const TurnMove& move : program.moves) part.cut(tool, move);
  return cpu_s() - start;
}

void measure_arcs(const TurningTool& tool) {
  constexpr int kArcs = 400;
  TurnedPart part = blank();
  const double start = cpu_s();
  for (int i = 0; i < kArcs; ++i) {
    // Quarters of a circle that goes deeper by 0.02 mm each time.
    const double r = 8 + 0.02 * i;
    TurnMove move{{-60 + r, kRadius_mm}, {-60, kRadius_mm - r}, std::nullopt, 0};
    move.arc = TurnArc{{-60, kRadius_mm}, -kPi / 2};
    part.cut(tool, move);
  }
  fmt::print(
      "arcs: {} quarters of 8 to 16 mm, {:.3f} s CPU, {:.2f} ms each, {} corners, {} by library\n",
      kArcs, cpu_s() - start, (cpu_s() - start) / kArcs * 1e3, part.corner_count(),
      part.library_calls());
}

/// 20 passes along 60 mm, with an entry and a way out; their volume is that of the groove.
void measure_threads() {
  constexpr double kPitch = 1.5, kDepth = 0.92, kBar = 12, kThreaded = 58;
  const TurningTool tool(*thread_insert({kPi / 3, 0.1875, 3, 6}));
  TurnedPart part = *TurnedPart::create(bar_profile(-kLength_mm, 0, 2 * kBar));
  const double start = cpu_s();
  for (int i = 1; i <= 20; ++i) {
    const double depth = kDepth * std::sqrt(i / 20.0), in = depth * std::tan(29.5 * kPi / 180);
    const double x = kBar - depth;
    const auto go = [&](const Vec2& from, const Vec2& to, double lead) {
      part.cut(tool, {from, to, std::nullopt, static_cast<std::uint64_t>(i), lead});
    };
    const double slant = std::hypot(kPitch, kDepth);
    go({5 - in, x + 2 + kDepth}, {5 - in, x + kDepth}, slant);
    go({5 - in, x + kDepth}, {3.5 - in, x}, slant);
    go({3.5 - in, x}, {-kThreaded - in, x}, kPitch);
    go({-kThreaded - in, x}, {-kThreaded - kPitch - in, x + kDepth}, slant);
    go({-kThreaded - kPitch - in, x + kDepth}, {-kThreaded - kPitch - in, 2 * kBar}, 0);
    go({-kThreaded - kPitch - in, 2 * kBar}, {5 - in, 2 * kBar}, 0);
  }
  const double cut_s = cpu_s() - start;
  // Of a stretch in the middle.
  TurnedPart middle = part;
  const TurningTool blade(*groove_insert({130, 0, 60, 1}));
  middle.cut(blade, {{-40, 80}, {-40, -1}, std::nullopt, 0});
  const TurningTool end(*groove_insert({80, 0, 60, 2}));
  middle.cut(end, {{-10, 80}, {-10, -1}, std::nullopt, 0});
  const double tan = std::tan(kPi / 6), r = kBar - kDepth, h = kDepth;
  const double moment = 0.1875 * (r * h + h * h / 2) + 2 * tan * (r * h * h / 2 + h * h * h / 3);
  const double expected = kPi * kBar * kBar * 30 - 2 * kPi / kPitch * 30 * moment;
  const double got = middle.remaining_mm3();
  if (!(std::abs(got / expected - 1) < 1e-6))
    fail(fmt::format("the threaded part has {} mm3, not {}", got, expected));
  fmt::print("threads: 20 passes of 40 turns, {:.1f} ms CPU, {} passes kept, {} bytes\n",
             cut_s * 1e3, part.threads().passes().size(), part.threads().unique_bytes());
  const double before = cpu_s();
  for (int i = 0; i < 100; ++i) part.section(0.01 * i);
  const double section_s = (cpu_s() - before) / 100, patches = cpu_s();
  std::size_t triangles = 0;
  for (std::size_t band = 0; band < TurnedPart::kBands; ++band)
    triangles += part.patch(band, 0).indices.size() / 3;
  const double patch_s = cpu_s() - patches, mesh = cpu_s();
  const std::size_t faces = part.mesh(0.01).triangles.size();
  fmt::print(
      "a section: {:.3f} ms; all patches: {:.1f} ms, {} triangles; a mesh of 0.01 mm: {:.1f} "
      "ms, {} triangles\n",
      section_s * 1e3, patch_s * 1e3, triangles, (cpu_s() - mesh) * 1e3, faces);
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  using namespace kerf;
  int runs = 3;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--runs" && i + 1 < argc) {
      runs = std::atoi(argv[++i]);
    } else {
      fail("unknown argument: " + arg);
    }
  }
  const Program program = make_program();
  const TurningTool tool(*nose_insert({kNose_mm, 2, 85 * kPi / 180, 25 * kPi / 180, 12}));
  TurnedPart part = blank();
  run(program, tool, part);
  // Chords of 0.07 mm, in whose middle a wave of curvature 1/20 mm lies 0.03 um deeper.
  const double expected = contour_mm3(), got = part_mm3(part);
  if (!(std::abs(got / expected - 1) < 2e-5))
    fail(fmt::format("the part has {} mm3, not {}", got, expected));
  const std::string digest = part.digest();
  double best = 1e300;
  for (int i = 0; i < runs; ++i) {
    best = std::min(best, run(program, tool, part));
    if (part.digest() != digest) fail("another digest");
  }
  fmt::print(
      "{} moves: {:.3f} s CPU, {:.2f} us a move, {} corners, {} by library, {:.1f} MB peak\n",
      program.moves.size(), best, best / static_cast<double>(program.moves.size()) * 1e6,
      part.corner_count(), part.library_calls(), peak_mb());
  const double start = cpu_s();
  std::vector<TurnedPart> copies;
  for (int i = 0; i < 1000; ++i) copies.push_back(part);
  fmt::print("a copy: {:.1f} us, {} bytes of its own\n", (cpu_s() - start) * 1e3,
             copies.back().unique_bytes());
  measure_arcs(tool);
  measure_threads();
  return 0;
}
