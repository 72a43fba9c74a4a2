// bench_zmap: how fast the Z-map cuts. Checks its results first, then times.
//
//   bench_zmap [--program FILE.ngc|FILE.canon --stock SPEC --tool SHAPE] [--cell MM] [--runs N]
//              [--workload NAME] [--kernel NAME]
//
// Without a program: the generated workloads (workloads.h), run through rs274. For each: cutting
// with one thread and with all, by each kernel of the machine, with and without a note of which
// move cut each cell; CPU seconds and wall seconds as minimum and median of N runs (default 5).
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "interp_bridge/program.h"
#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/bench/workloads.h"
#include "tests/stock/sweep_oracle.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

struct Job {
  std::string name, path, stock, shape;
};

struct Arguments {
  std::vector<Job> jobs;
  double cell_mm = 0.1;
  int runs = 5;
  std::string kernel;  ///< of the machine, all of them if empty
};

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_zmap: {}\n", why);
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

double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<CutMove> moves_of(const Job& job) {
  ProgramOptions options;
  options.path = job.path;
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
  if (moves.empty()) fail(job.name + ": no moves");
  return moves;
}

std::unique_ptr<ZMap> make_map(const Job& job, double cell_mm, int threads, ZMapKernel kernel) {
  ZMapOptions options;
  const Result<Blank> blank = parse_blank(job.stock);
  if (!blank) fail(blank.error());
  options.blank = *blank;
  options.cell_mm = cell_mm;
  options.threads = threads;
  options.kernel = kernel;
  Result<std::unique_ptr<ZMap>> map = ZMap::create(options);
  if (!map) fail(map.error());
  return std::move(*map);
}

void cut(ZMap& map, const Cutter& cutter, std::span<const CutMove> moves) {
  std::vector<CutReport> reports;
  for (std::size_t i = 0; i < moves.size(); i += 4096) {
    reports.clear();
    map.cut(cutter, moves.subspan(i, std::min<std::size_t>(4096, moves.size() - i)), reports);
  }
  map.finish(reports);
}

/// Heights of a few hundred cells against brute force over every move near them.
double worst_error(const ZMap& map, const Cutter& cutter, std::span<const CutMove> moves) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> column(0, map.nx() - 1), line(0, map.ny() - 1);
  const Box box = map.bounds_mm();
  const double reach = cutter.radius_mm() + 0.01;
  double worst = 0;
  for (int n = 0; n < 300; ++n) {
    const int i = column(random), j = line(random);
    const double x = box.min.x + (i + 0.5) * box.size().x / map.nx(),
                 y = box.min.y + (j + 0.5) * box.size().y / map.ny();
    double z = box.max.z;
    bool ambiguous = false;
    for (const CutMove& m : moves) {
      const double arm =
          m.arc ? 2 * std::hypot(m.from_mm.x - m.arc->center_mm.x, m.from_mm.y - m.arc->center_mm.y)
                : 0;
      if (x < std::min(m.from_mm.x, m.to_mm.x) - reach - arm ||
          x > std::max(m.from_mm.x, m.to_mm.x) + reach + arm ||
          y < std::min(m.from_mm.y, m.to_mm.y) - reach - arm ||
          y > std::max(m.from_mm.y, m.to_mm.y) + reach + arm)
        continue;
      const test::OracleHeight h = test::sweep_height(cutter, m, x, y, m.arc ? 200 : 8);
      ambiguous |= h.edge_distance < 2e-7;
      z = std::min(z, h.z);
    }
    if (!ambiguous)
      worst = std::max(worst,
                       std::abs(static_cast<double>(map.height_mm(i, j)) - std::max(z, box.min.z)));
  }
  return worst;
}

std::string machine() {
  std::string name = "unknown CPU", line;
  std::ifstream info("/proc/cpuinfo");
  while (std::getline(info, line)) {
    if (line.starts_with("model name")) {
      name = line.substr(line.find(':') + 2);
      break;
    }
  }
  return fmt::format("{}, {} threads, g++ {}", name, std::thread::hardware_concurrency(),
                     __VERSION__);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void time_job(const Job& job, double cell_mm, int runs, std::string_view only) {
  const std::vector<CutMove> moves = moves_of(job);
  const Result<Cutter> cutter = parse_shape(job.shape);
  if (!cutter) fail(cutter.error());
  std::string digest;
  const int all = std::max(2, static_cast<int>(std::thread::hardware_concurrency()));
  struct Variant {
    ZMapKernel kernel;
    int threads;
    bool cut_ids;
  };
  std::vector<Variant> variants;
  for (const ZMapKernel kernel : zmap_kernels()) {
    if (!only.empty() && only != to_string(kernel)) continue;
    for (const int threads : {1, all}) {
      if (threads > 1 && (kernel != zmap_kernels().front() || !only.empty())) continue;
      for (const bool cut_ids : {false, true}) variants.push_back({kernel, threads, cut_ids});
    }
  }
  for (const Variant& v : variants) {
    std::vector<double> cpu, wall;
    std::size_t cells = 0;
    for (int run = 0; run < runs; ++run) {
      const std::unique_ptr<ZMap> map = make_map(job, cell_mm, v.threads, v.kernel);
      cells = map->cell_count();
      map->keep_cut_ids(v.cut_ids);
      const double cpu0 = cpu_s(), wall0 = wall_s();
      cut(*map, *cutter, moves);
      cpu.push_back(cpu_s() - cpu0);
      wall.push_back(wall_s() - wall0);
      if (run > 0) continue;
      if (digest.empty()) {
        const double error = worst_error(*map, *cutter, moves);
        fmt::print(
            "{}: {} moves, {}, {}, {:.2f} M cells of {} mm; worst of 300 heights {:.2g} mm off\n",
            job.name, moves.size(), job.shape, job.stock, static_cast<double>(cells) / 1e6, cell_mm,
            error);
        if (error > 1e-4) fail("wrong heights");
        digest = map->digest();
      } else if (map->digest() != digest) {
        fail("the result depends on the kernel, the threads or the ids");
      }
    }
    const double best = *std::min_element(cpu.begin(), cpu.end());
    fmt::print(
        "  {:<26} CPU {:.4f} s min, {:.4f} median   wall {:.4f} min, {:.4f} median   "
        "{:.3g} moves/s CPU\n",
        fmt::format("{}, {} thread{}{}", to_string(v.kernel), v.threads, v.threads == 1 ? "" : "s",
                    v.cut_ids ? ", cut ids" : ""),
        best, median(cpu), *std::min_element(wall.begin(), wall.end()), median(wall),
        static_cast<double>(moves.size()) / best);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print("  digest {}, peak {} MB (of which the moves, kept here, {} MB)\n", digest,
             usage.ru_maxrss / 1024, moves.size() * sizeof(CutMove) / 1'000'000);
}

Arguments parse(int argc, char** argv, const fs::path& folder) {
  Arguments a;
  Job own;
  std::string workload;
  for (int i = 1; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 >= argc) fail(key + " needs a value");
    const std::string value = argv[i + 1];
    if (key == "--program")
      own.path = value, own.name = fs::path(value).filename().string();
    else if (key == "--stock")
      own.stock = value;
    else if (key == "--tool")
      own.shape = value;
    else if (key == "--cell")
      a.cell_mm = std::strtod(value.c_str(), nullptr);
    else if (key == "--workload")
      workload = value;
    else if (key == "--kernel")
      a.kernel = value;
    else if (key == "--runs")
      a.runs = std::max(1, std::atoi(value.c_str()));
    else
      fail("unknown option " + key);
  }
  if (!own.path.empty()) {
    if (own.stock.empty() || own.shape.empty()) fail("--program needs --stock and --tool");
    a.jobs.push_back(own);
    return a;
  }
  for (const Workload& w : workloads()) {
    if (w.turns || (!workload.empty() && workload != w.name)) continue;
    const fs::path path = folder / (std::string(w.name) + ".ngc");
    std::ofstream(path) << w.program();
    const std::string tool(w.tool);
    a.jobs.push_back({std::string(w.name), path.string(), std::string(w.stock),
                      tool.substr(tool.find('=') + 1)});
  }
  return a;
}

int run(int argc, char** argv) {
  std::string pattern = (fs::temp_directory_path() / "kerf-bench-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) fail("no temporary folder");
  const Arguments arguments = parse(argc, argv, pattern);
  fmt::print("{}\n", machine());
  for (const Job& job : arguments.jobs)
    time_job(job, arguments.cell_mm, arguments.runs, arguments.kernel);
  fs::remove_all(pattern);
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) { return kerf::run(argc, argv); }
