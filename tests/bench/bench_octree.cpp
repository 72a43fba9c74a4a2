// bench_octree: how fast the octree cuts. Checks its results against the Z-map first, then times.
//
//   bench_octree [--program FILE.ngc|FILE.canon --stock SPEC --tool SHAPE] [--cell MM] [--runs N]
//                [--threads N]
//
// Without a program: the generated workload w3_trochoid, a 20-block program with a ball nose, and
// one and the same cut in blocks of growing size. CPU seconds, the least of N runs (default 3).
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "interp_bridge/program.h"
#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"
#include "stock/zmap/zmap.h"
#include "tests/bench/workloads.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string program, stock, tool;
  double cell_mm = 0.1;
  int runs = 3, threads = 1;
};

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_octree: {}\n", why);
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

std::vector<CutMove> moves_of(const std::string& path) {
  ProgramOptions options;
  options.path = path;
  Diagnostics diagnostics;
  const std::unique_ptr<Program> program = Program::open(options, diagnostics);
  std::vector<CutMove> moves;
  if (program) {
    program->run(
        [&](std::span<const Motion> batch) {
          for (const Motion& m : batch) {
            const bool cuts = m.kind == MotionKind::kTraverse || m.kind == MotionKind::kFeed ||
                              m.kind == MotionKind::kArc;
            if (!cuts || !m.start_known) continue;
            CutMove move;
            move.from_mm = m.from_mm;
            move.to_mm = m.to_mm;
            move.id = moves.size();
            if (m.kind == MotionKind::kArc)
              move.arc = CutArc{m.arc.center_mm, m.arc.axis, m.arc.sweep_rad};
            moves.push_back(move);
          }
          return true;
        },
        {}, diagnostics);
  }
  for (const Diagnostic& d : diagnostics) fmt::print(stderr, "{}", to_string(d));
  if (moves.empty()) fail(path + ": no moves");
  return moves;
}

std::unique_ptr<Octree> make_octree(const Blank& blank, double cell_mm, int threads) {
  OctreeOptions options;
  options.blank = blank;
  options.cell_mm = cell_mm;
  options.threads = threads;
  Result<std::unique_ptr<Octree>> tree = Octree::create(options);
  if (!tree) fail(tree.error());
  return std::move(*tree);
}

double cut(StockModel& model, const Cutter& cutter, std::span<const CutMove> moves) {
  std::vector<CutReport> reports;
  const double begin = cpu_s();
  for (std::size_t i = 0; i < moves.size(); i += 4096) {
    reports.clear();
    model.cut(cutter, moves.subspan(i, std::min<std::size_t>(4096, moves.size() - i)), reports);
  }
  model.finish(reports);
  return cpu_s() - begin;
}

void time_job(const std::string& name, const std::string& stock, const std::string& shape,
              std::span<const CutMove> moves, const Arguments& arguments) {
  const Result<Blank> blank = parse_blank(stock);
  const Result<Cutter> cutter = parse_shape(shape);
  if (!blank || !cutter) fail(blank ? cutter.error() : blank.error());
  ZMapOptions zmap_options;
  zmap_options.blank = *blank;
  zmap_options.cell_mm = arguments.cell_mm;
  Result<std::unique_ptr<ZMap>> zmap = ZMap::create(zmap_options);
  if (!zmap) fail(zmap.error());
  cut(**zmap, *cutter, moves);
  const double expected = (*zmap)->blank_mm3() - (*zmap)->remaining_mm3();

  double best = 1e9, off = 0;
  std::size_t bytes = 0, bricks = 0;
  std::string digest;
  for (int run = 0; run < arguments.runs; ++run) {
    const std::size_t before = mallinfo2().uordblks;
    const auto tree = make_octree(*blank, arguments.cell_mm, arguments.threads);
    best = std::min(best, cut(*tree, *cutter, moves));
    bytes = mallinfo2().uordblks - before;
    bricks = tree->brick_count();
    const double removed = tree->blank_mm3() - tree->remaining_mm3();
    off = removed / expected - 1;
    if (std::abs(off) > 0.002)
      fail(fmt::format("{}: removed {:.1f} mm3, the Z-map {:.1f}", name, removed, expected));
    if (!digest.empty() && digest != tree->digest()) fail("another result the second time");
    digest = tree->digest();
  }
  fmt::print(
      "{}: {} moves, {}, {}, {} mm, {} thread(s): CPU {:.3f} s, {:.1f} MB in {} bricks; removed "
      "{:.1f} mm3 ({:+.4f} % against the Z-map)\n",
      name, moves.size(), shape, stock, arguments.cell_mm, arguments.threads, best,
      static_cast<double>(bytes) / 1e6, bricks, expected * (1 + off), 100 * off);
}

CutMove line(const Vec3& from, const Vec3& to) {
  CutMove move;
  move.from_mm = from;
  move.to_mm = to;
  return move;
}

/// Twenty blocks: a square spiral down a block, as small published examples have it.
std::vector<CutMove> twenty_blocks() {
  std::vector<CutMove> moves;
  Vec3 at{10, 10, 5};
  const auto go = [&](const Vec3& to) {
    moves.push_back(line(at, to));
    at = to;
  };
  for (int ring = 0; ring < 4; ++ring) {
    const double in = 10 + 5 * ring, out = 60 - in, z = -2.0 - ring;
    go({in, in, z});
    go({out, in, z});
    go({out, out, z});
    go({in, out, z});
    go({in, in, z});
  }
  return moves;
}

void time_sizes(const Arguments& arguments) {
  const Result<Cutter> cutter = parse_shape("ball:6");
  std::vector<CutMove> moves;
  for (int row = 0; row < 200; ++row)
    moves.push_back(line({5.0, 5 + 0.1 * row, -2}, {25, 5 + 0.1 * row, -2 - 0.01 * row}));
  fmt::print("the same 200 moves of 20 mm in blocks of growing size:\n");
  for (const int side : {30, 60, 120, 240, 480}) {
    const Result<Blank> blank =
        parse_blank(fmt::format("box:0,0,{}:{},{},0", -side / 2, side, side));
    const auto tree = make_octree(*blank, 0.1, arguments.threads);
    const double seconds = cut(*tree, *cutter, moves);
    fmt::print("  {0} x {0} x {1} mm: {2:.1f} us a move\n", side, side / 2,
               1e6 * seconds / static_cast<double>(moves.size()));
  }
}

Arguments parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 >= argc) fail(key + " needs a value");
    const std::string value = argv[i + 1];
    if (key == "--program")
      a.program = value;
    else if (key == "--stock")
      a.stock = value;
    else if (key == "--tool")
      a.tool = value;
    else if (key == "--cell")
      a.cell_mm = std::strtod(value.c_str(), nullptr);
    else if (key == "--runs")
      a.runs = std::max(1, std::atoi(value.c_str()));
    else if (key == "--threads")
      a.threads = std::max(1, std::atoi(value.c_str()));
    else
      fail("unknown option " + key);
  }
  return a;
}

int run(int argc, char** argv) {
  const Arguments arguments = parse(argc, argv);
  if (!arguments.program.empty()) {
    if (arguments.stock.empty() || arguments.tool.empty())
      fail("--program needs --stock and --tool");
    time_job(fs::path(arguments.program).filename().string(), arguments.stock, arguments.tool,
             moves_of(arguments.program), arguments);
    return 0;
  }
  time_job("twenty blocks", "box:0,0,-20:60,60,0", "ball:6", twenty_blocks(), arguments);
  std::string pattern = (fs::temp_directory_path() / "kerf-bench-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) fail("no temporary folder");
  for (const Workload& w : workloads()) {
    if (w.name != "w3_trochoid") continue;
    const fs::path path = fs::path(pattern) / "w3.ngc";
    std::ofstream(path) << w.program();
    const std::string tool(w.tool);
    time_job(std::string(w.name), std::string(w.stock), tool.substr(tool.find('=') + 1),
             moves_of(path.string()), arguments);
  }
  fs::remove_all(pattern);
  time_sizes(arguments);
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) { return kerf::run(argc, argv); }
