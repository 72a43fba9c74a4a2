// bench_octree: how fast the octree cuts. Checks its results against the Z-map first, then times.
//
//   bench_octree [--program FILE.ngc|FILE.canon --stock SPEC --tool SHAPE] [--cell MM] [--runs N]
//                [--threads N] [--kernel NAME]
//   bench_octree --goal all|w1|finish|five [--share N] [--runs N] [--kernel NAME]
//
// Without a program: the generated workload w3_trochoid, a 20-block program with a ball nose, and
// one and the same cut in blocks of growing size. CPU seconds, the least of N runs (default 3).
// --goal: w1 (3D_Chips), 50 000 finishing moves, a million moves whose spindle turns (--share 20: a
// twentieth of them), against rs274 on w2_finish_1m; after a look whether their bits are those that
// single moves of the scalar kernel leave.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "interp_bridge/program.h"
#include "stock/cutter/shape_spec.h"
#include "stock/octree/octree.h"
#include "stock/zmap/zmap.h"
#include "tests/bench/process_usage.h"
#include "tests/bench/workloads.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string program, stock, tool;
  double cell_mm = 0.1;
  int runs = 3, threads = 1;
  std::string goal;  ///< only this one
  int share = 1;     ///< a part of its moves
  octree::KernelChoice kernel = octree::KernelChoice::kAuto;
};

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_octree: {}\n", why);
  std::exit(2);
}

double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
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

std::unique_ptr<Octree> make_octree(const Blank& blank, double cell_mm, int threads,
                                    octree::KernelChoice kernel) {
  OctreeOptions options;
  options.blank = blank;
  options.cell_mm = cell_mm;
  options.threads = threads;
  options.kernel = kernel;
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
    const auto tree = make_octree(*blank, arguments.cell_mm, arguments.threads, arguments.kernel);
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
    const auto tree = make_octree(*blank, 0.1, arguments.threads, arguments.kernel);
    const double seconds = cut(*tree, *cutter, moves);
    fmt::print("  {0} x {0} x {1} mm: {2:.1f} us a move\n", side, side / 2,
               1e6 * seconds / static_cast<double>(moves.size()));
  }
}

struct Job {
  std::string name, stock, tool;
  double cell_mm;
  std::vector<CutMove> moves;
};

double wavy_mm(double x, double y) { return -3 + std::sin(x / 7) * std::cos(y / 9); }

/// A wavy surface in rows, as it is finished: `rows` of `count` moves of 0.2 mm, half a millimetre
/// apart. `tilt_rad`: the spindle leans so far, to a side that changes along the way.
std::vector<CutMove> finishing(int rows, int count, double apart_mm, double tilt_rad) {
  std::vector<CutMove> moves;
  const auto tip = [&](int row, int n) {
    const double x = 0.2 * (row % 2 == 0 ? n : count - n), y = apart_mm * row;
    return Vec3{x, y, wavy_mm(x, y)};
  };
  const auto axis = [&](const Vec3& at) {
    const double lead = tilt_rad * std::sin(at.x / 11), side = tilt_rad * std::cos(at.y / 13);
    return glm::normalize(Vec3{std::sin(lead), std::sin(side), 1});
  };
  Vec3 at = tip(0, 0);
  for (int row = 0; row < rows; ++row) {
    for (int n = row == 0 ? 1 : 0; n <= count; ++n) {
      CutMove move = line(at, tip(row, n));
      if (tilt_rad != 0) {
        move.axis_from = axis(move.from_mm);
        move.axis_to = axis(move.to_mm);
      }
      move.id = moves.size();
      at = move.to_mm;
      moves.push_back(move);
    }
  }
  return moves;
}

/// The bits that the moves leave one by one, by the scalar kernel.
std::string plain_digest(const Job& job, const Blank& blank, const Cutter& cutter) {
  const auto tree = make_octree(blank, job.cell_mm, 1, octree::KernelChoice::kScalar);
  std::vector<CutReport> reports;
  for (const CutMove& move : job.moves) {
    reports.clear();
    tree->cut(cutter, std::span(&move, 1), reports);
  }
  return tree->digest();
}

/// The unit: LinuxCNC's interpreter alone on w2_finish_1m, the best of two.
double rs274_s() {
  std::string pattern = (fs::temp_directory_path() / "kerf-bench-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) fail("no temporary folder");
  const std::string program = pattern + "/w2.ngc";
  for (const Workload& w : workloads())
    if (w.name == "w2_finish_1m") std::ofstream(program) << w.program();
  const std::string command =
      fmt::format("HOME='{0}' rs274 -n 2 -g '{1}' > '{0}/listing' 2>&1", pattern, program);
  double best = 1e9;
  for (int run = 0; run < 2; ++run) {
    const double begin = wall_s();
    if (std::system(command.c_str()) != 0) fail("rs274 does not run here");
    best = std::min(best, wall_s() - begin);
  }
  fs::remove_all(pattern);
  return best;
}

constexpr const char* kChips = "/usr/share/linuxcnc/ncfiles/3D_Chips.ngc";

/// What is asked of finishing and of five axes. `share`: only so much of the long one.
std::vector<Job> goals(const std::string& only, int share) {
  std::vector<Job> jobs;
  const auto wanted = [&](const char* name) { return only == "all" || only == name; };
  if (wanted("w1") && fs::exists(kChips))
    jobs.push_back({"w1", "box:-50,-50,-50:50,50,0", "ball:10", 0.1, moves_of(kChips)});
  if (wanted("finish"))
    jobs.push_back(
        {"finish", "box:0,0,-20:100,50,0", "ball:6", 0.1, finishing(100 / share, 499, 0.5, 0)});
  if (wanted("five"))
    jobs.push_back(
        {"five", "box:0,0,-20:200,200,0", "ball:6", 0.1, finishing(1000 / share, 999, 0.2, 0.3)});
  return jobs;
}

/// Times a job with one thread and with two, after a look at its bits. `rs274_s`: the unit.
void time_goal(const Job& job, double rs274_s, int runs, octree::KernelChoice kernel) {
  const Result<Blank> blank = parse_blank(job.stock);
  const Result<Cutter> cutter = parse_shape(job.tool);
  if (!blank || !cutter) fail(blank ? cutter.error() : blank.error());
  const std::string expected = plain_digest(job, *blank, *cutter);
  double cpu = 1e9, wall = 1e9;
  std::size_t bytes = 0;
  for (int run = 0; run < runs; ++run) {
    for (const int threads : {1, 2}) {
      const std::size_t before = mallinfo2().uordblks;
      const auto tree = make_octree(*blank, job.cell_mm, threads, kernel);
      const double begin = wall_s(), used = cut(*tree, *cutter, job.moves);
      if (threads == 1)
        cpu = std::min(cpu, used);
      else
        wall = std::min(wall, wall_s() - begin);
      bytes = mallinfo2().uordblks - before;
      if (tree->digest() != expected) fail(job.name + ": not what single scalar moves leave");
    }
  }
  const double count = static_cast<double>(job.moves.size());
  fmt::print(
      "{}: {} moves, {}, {} mm: CPU {:.3f} s ({:.2f} of rs274, {:.0f} moves a second), two threads "
      "{:.3f} s by the clock ({:.2f}); {:.1f} MB; {}\n",
      job.name, job.moves.size(), job.tool, job.cell_mm, cpu, cpu / rs274_s, count / cpu, wall,
      wall / rs274_s, static_cast<double>(bytes) / 1e6, expected);
}

octree::KernelChoice kernel_of(const std::string& name) {
  if (name == "auto") return octree::KernelChoice::kAuto;
  if (name == "scalar") return octree::KernelChoice::kScalar;
  if (name == "avx2" && octree::has_avx2()) return octree::KernelChoice::kAvx2;
  if (name == "avx512" && octree::has_avx512()) return octree::KernelChoice::kAvx512;
  fail("--kernel " + name + " is not known, or this machine has not got it");
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
    else if (key == "--goal")
      a.goal = value;
    else if (key == "--share")
      a.share = std::max(1, std::atoi(value.c_str()));
    else if (key == "--kernel")
      a.kernel = kernel_of(value);
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
  if (!arguments.goal.empty()) {
    const std::vector<Job> jobs = goals(arguments.goal, arguments.share);
    if (jobs.empty()) fail("--goal: all, w1, finish or five");
    const double rs274 = rs274_s();
    for (const Job& job : jobs) time_goal(job, rs274, arguments.runs, arguments.kernel);
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
