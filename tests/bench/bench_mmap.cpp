// bench_mmap: what the M-map costs beside the Z-map on programs that need no undercuts, and how
// fast it cuts those that do. Checks its results first, then times.
//
//   bench_mmap [--cell MM] [--runs N]
//
// Raster finishing of a wavy surface and a trochoidal slot with monotone cutters, in both models,
// taking turns; then the same M-map with gaps under all of it, and with gaps among the cuts; then
// grooves with cutters that have a head. CPU seconds, minimum and median of N runs (default 7), one
// thread.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/mmap/mmap.h"

namespace kerf {
namespace {

constexpr const char* kBlank = "box:0,0,-20:100,100,0";

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_mmap: {}\n", why);
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

ZMapOptions options(double cell_mm) {
  ZMapOptions out;
  out.blank = *parse_blank(kBlank);
  out.cell_mm = cell_mm;
  return out;
}

CutMove line(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

/// Moves of 0.5 mm along x, lines 0.2 mm apart.
std::vector<CutMove> raster() {
  std::vector<CutMove> moves;
  const auto surface = [](double x, double y) {
    return -4 + 2 * std::sin(0.12 * x) * std::cos(0.1 * y);
  };
  Vec3 at(0, 0, surface(0, 0));
  for (int row = 0; row <= 500; ++row) {
    const double y = 0.2 * row;
    for (int n = 0; n <= 200; ++n) {
      const double x = row % 2 == 0 ? 0.5 * n : 100 - 0.5 * n;
      const Vec3 to(x, y, surface(x, y));
      moves.push_back(line(at, to));
      at = to;
    }
  }
  return moves;
}

/// Full circles that advance 0.5 mm.
std::vector<CutMove> trochoid(double z) {
  std::vector<CutMove> moves;
  for (int row = 0; row < 8; ++row) {
    for (int n = 0; n <= 200; ++n) {
      const Vec3 center(0.5 * n, 6 + 12.5 * row, z), start = center + Vec3(4, 0, 0);
      if (n > 0) moves.push_back(line(start - Vec3(0.5, 0, 0), start));
      CutMove circle = line(start, start);
      circle.arc = CutArc{center, Vec3(0, 0, 1), 2 * kPi};
      moves.push_back(circle);
    }
  }
  return moves;
}

/// Grooves from side to side in steps of `step` mm, weaving a little.
std::vector<CutMove> grooves(double z, double step) {
  std::vector<CutMove> moves;
  for (int row = 0; row < 6; ++row) {
    Vec3 at(-10, 8 + 16 * row, z);
    while (at.x < 110) {
      const double x = at.x + step;
      const Vec3 to(x, 8 + 16 * row + std::sin(0.2 * x), z);
      moves.push_back(line(at, to));
      at = to;
    }
  }
  return moves;
}

void cut(StockModel& map, const Cutter& cutter, std::span<const CutMove> moves) {
  std::vector<CutReport> reports;
  for (std::size_t i = 0; i < moves.size(); i += 4096) {
    reports.clear();
    map.cut(cutter, moves.subspan(i, std::min<std::size_t>(4096, moves.size() - i)), reports);
  }
  map.finish(reports);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

using Model = std::function<std::unique_ptr<StockModel>()>;

double time_of(const Model& make, const Cutter& cutter, std::span<const CutMove> moves) {
  const std::unique_ptr<StockModel> map = make();
  const double start = cpu_s();
  cut(*map, cutter, moves);
  return cpu_s() - start;
}

void print(const std::string& name, std::size_t moves, const std::vector<double>& cpu) {
  const double best = *std::min_element(cpu.begin(), cpu.end());
  fmt::print("  {:<30} CPU {:.4f} s min, {:.4f} median   {:.3g} moves/s\n", name, best, median(cpu),
             static_cast<double>(moves) / best);
}

/// A thin gap in every tile.
std::unique_ptr<StockModel> with_gaps(const ZMapOptions& o, double z) {
  std::unique_ptr<StockModel> map = std::move(*MMap::create(o));
  std::vector<CutMove> moves;
  for (int row = 0; row < 16; ++row)
    moves.push_back(line(Vec3(-10, 3 + 6.2 * row, z), Vec3(110, 3 + 6.2 * row, z)));
  cut(*map, *parse_shape("tslot:6:0.2:0.5"), moves);
  return map;
}

void compare(const std::string& name, const std::string& shape, const std::vector<CutMove>& moves,
             double cell_mm, int runs) {
  const Cutter cutter = *parse_shape(shape);
  const ZMapOptions o = options(cell_mm);
  const Model zmap = [&]() -> std::unique_ptr<StockModel> { return std::move(*ZMap::create(o)); };
  const Model mmap = [&]() -> std::unique_ptr<StockModel> { return std::move(*MMap::create(o)); };
  const std::unique_ptr<StockModel> a = zmap(), b = mmap();
  cut(*a, cutter, moves);
  cut(*b, cutter, moves);
  if (a->digest() != b->digest()) fail(name + ": the M-map differs from the Z-map");
  std::vector<double> z, m, below, among;
  for (int run = 0; run < runs; ++run) {
    z.push_back(time_of(zmap, cutter, moves));
    m.push_back(time_of(mmap, cutter, moves));
    below.push_back(time_of([&] { return with_gaps(o, -19.5); }, cutter, moves));
    among.push_back(time_of([&] { return with_gaps(o, -4.5); }, cutter, moves));
  }
  const auto best = [](const std::vector<double>& v) {
    return *std::min_element(v.begin(), v.end());
  };
  fmt::print(
      "{}: {} moves, {}, {}, cells of {} mm; M-map / Z-map {:.3f}, gaps below {:.2f}, gaps among "
      "the "
      "cuts {:.2f}\n",
      name, moves.size(), shape, kBlank, cell_mm, best(m) / best(z), best(below) / best(z),
      best(among) / best(z));
  print("Z-map", moves.size(), z);
  print("M-map", moves.size(), m);
  print("M-map, gaps below in every tile", moves.size(), below);
  print("M-map, gaps among the cuts", moves.size(), among);
}

void time_headed(const std::string& name, const std::string& shape,
                 const std::vector<CutMove>& moves, double cell_mm, int runs) {
  const Cutter cutter = *parse_shape(shape);
  const ZMapOptions o = options(cell_mm);
  const Model mmap = [&]() -> std::unique_ptr<StockModel> { return std::move(*MMap::create(o)); };
  const std::unique_ptr<StockModel> map = mmap();
  std::vector<CutReport> reports;
  map->cut(cutter, moves, reports);
  map->finish(reports);
  double removed = 0;
  for (const CutReport& report : reports) removed += report.removed_mm3;
  const double gone = map->blank_mm3() - map->remaining_mm3();
  if (std::abs(removed - gone) > 1e-3 * gone) fail(name + ": the reports do not add up");
  const std::string digest = map->digest();
  cut(*map, cutter, moves);
  if (map->digest() != digest) fail(name + ": cut twice it is not the same");
  std::vector<double> cpu;
  for (int run = 0; run < runs; ++run) cpu.push_back(time_of(mmap, cutter, moves));
  fmt::print("{}: {} moves, {}, {}, cells of {} mm; {:.0f} mm3 removed, {:.1f} MB of its own\n",
             name, moves.size(), shape, kBlank, cell_mm, removed,
             static_cast<double>(map->unique_bytes()) / 1e6);
  print("M-map", moves.size(), cpu);
  const double start = cpu_s();
  const TriangleMesh mesh = map->mesh(0);
  fmt::print("  mesh: {} triangles, CPU {:.2f} s\n", mesh.triangles.size(), cpu_s() - start);
}

int run(int argc, char** argv) {
  double cell_mm = 0.1;
  int runs = 7;
  for (int i = 1; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 >= argc) fail(key + " needs a value");
    if (key == "--cell")
      cell_mm = std::strtod(argv[i + 1], nullptr);
    else if (key == "--runs")
      runs = std::max(1, std::atoi(argv[i + 1]));
    else
      fail("unknown option " + key);
  }
  compare("raster", "ball:6", raster(), cell_mm, runs);
  compare("trochoid", "flat:6", trochoid(-5), cell_mm, runs);
  time_headed("long grooves", "tslot:12:3:5", grooves(-10, 30), cell_mm, runs);
  time_headed("weaving grooves", "tslot:12:3:5", grooves(-10, 0.5), cell_mm, runs);
  time_headed("weaving grooves", "lollipop:8:4", grooves(-10, 0.5), cell_mm, runs);
  time_headed("weaving grooves", "dovetail:12:60:6", grooves(-10, 0.5), cell_mm, runs);
  time_headed("trochoid", "tslot:6:2:3", trochoid(-10), cell_mm, runs);
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) { return kerf::run(argc, argv); }
