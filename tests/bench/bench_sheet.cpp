// bench_sheet: how fast a sheet is cut. Checks its results first, then times.
//
//   bench_sheet [--runs N] [--unsplit] [--nest-only]
//
// Generated programs: 560 and 834 moves of simple parts on a sheet of 3000 x 1500 mm, a nest of
// 12 371 moves (full circles and straight lines, about a million corners at the end), nests of
// up to 200 000 moves on larger sheets, and short chords. Times hold cutting and recognition;
// CPU seconds, the least of N runs (default 3), and the longest single move. --unsplit: the nest of
// 12 371 moves in one tile as well, which takes minutes. --nest-only: the nest alone, as divided by
// the model, to count instructions of.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/sheet/sheet.h"

namespace kerf {
namespace {

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_sheet: {}\n", why);
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

struct Job {
  std::string name;
  Vec2 size_mm;
  std::vector<CutMove> moves;
  std::size_t parts = 0;  ///< that come free
};

class Program {
 public:
  void line(const Vec2& to) {
    CutMove move;
    move.from_mm = Vec3(at_, 0);
    move.to_mm = Vec3(to, 0);
    add(move, to);
  }
  void arc(const Vec2& to, const Vec2& center, double sweep) {
    CutMove move;
    move.from_mm = Vec3(at_, 0);
    move.to_mm = Vec3(to, 0);
    move.arc = CutArc{Vec3(center, 0), {0, 0, 1}, sweep};
    add(move, to);
  }
  void go(const Vec2& to) { at_ = to; }
  std::vector<CutMove> take() { return std::move(moves_); }
  std::size_t size() const { return moves_.size(); }

 private:
  void add(CutMove& move, const Vec2& to) {
    move.id = moves_.size();
    moves_.push_back(move);
    at_ = to;
  }
  Vec2 at_{0};
  std::vector<CutMove> moves_;
};

/// Discs in a lattice, each with holes: a lead-in (a line) and a full circle for each contour, the
/// inner ones first. Three contours a part: six moves.
Job nest_of_discs(std::size_t moves, const Vec2& size, double pitch_mm) {
  Job job{fmt::format("nest {}", moves), size, {}, 0};
  Program program;
  const int columns = static_cast<int>(size.x / pitch_mm);
  const double outer = pitch_mm * 0.44, inner = pitch_mm * 0.17;
  for (int part = 0; program.size() < moves; ++part) {
    const Vec2 c((part % columns + 0.5) * pitch_mm, (part / columns + 0.5) * pitch_mm);
    const auto contour = [&](const Vec2& center, double radius, double lead) {
      if (program.size() + 2 > moves) {
        // One move is left: a mark beside the part.
        while (program.size() < moves) {
          program.go(c + Vec2(pitch_mm * 0.47, pitch_mm * 0.47));
          program.line(c + Vec2(pitch_mm * 0.48, pitch_mm * 0.48));
        }
        return;
      }
      program.go(center + Vec2(radius + lead, 0));
      program.line(center + Vec2(radius, 0));
      program.arc(center + Vec2(radius, 0), center, lead > 0 ? -2 * kPi : 2 * kPi);
      ++job.parts;
    };
    contour(c + Vec2(pitch_mm * 0.2, 0), inner, -2);
    contour(c - Vec2(pitch_mm * 0.2, 0), inner, -2);
    contour(c, outer, 2);
  }
  job.moves = program.take();
  return job;
}

/// Plates with rounded corners and a hole: nine lines and arcs, two of them lead-ins, then a circle
/// in two halves.
Job simple_parts(std::size_t moves, const Vec2& size) {
  Job job{fmt::format("simple {}", moves), size, {}, 0};
  Program program;
  const double pitch = std::sqrt(size.x * size.y / (static_cast<double>(moves) / 12 + 1)) * 0.9;
  const int columns = static_cast<int>(size.x / pitch);
  for (int part = 0; program.size() + 12 <= moves; ++part) {
    const Vec2 c((part % columns + 0.5) * pitch, (part / columns + 0.5) * pitch);
    const double h = pitch * 0.42, r = pitch * 0.1, hole = pitch * 0.2;
    program.go(c + Vec2(hole - 3, 0));
    program.line(c + Vec2(hole, 0));
    program.arc(c - Vec2(hole, 0), c, kPi);
    program.arc(c + Vec2(hole, 0), c, kPi);
    program.go(c + Vec2(h + 4, -h + r));
    program.line(c + Vec2(h, -h + r));
    for (int side = 0; side < 4; ++side) {
      const auto turned = [&](double x, double y) {
        const double cosine[] = {1, 0, -1, 0}, sine[] = {0, 1, 0, -1};
        return c + Vec2(cosine[side] * x - sine[side] * y, sine[side] * x + cosine[side] * y);
      };
      program.line(turned(h, h - r));
      program.arc(turned(h - r, h), turned(h - r, h - r), kPi / 2);
    }
    job.parts += 2;
  }
  while (program.size() < moves) {
    program.go({size.x - 1, static_cast<double>(program.size() % 100)});
    program.line({size.x, static_cast<double>(program.size() % 100)});
  }
  job.moves = program.take();
  return job;
}

/// A nibbled wave of short chords: what a drawing program makes of splines.
Job splines(std::size_t moves, const Vec2& size) {
  Job job{fmt::format("splines {}", moves), size, {}, 0};
  Program program;
  double x = 5, y = 20;
  program.go({x, y});
  for (std::size_t i = 0; i < moves; ++i) {
    x += 0.5;
    if (x > size.x - 5) {
      x = 5;
      y += 15;
      program.go({x, y});
    }
    program.line({x, y + 5 * std::sin(x / 4)});
  }
  job.moves = program.take();
  return job;
}

/// The nest, and at its end one cut across the sheet, between two columns of parts: the move that
/// parts it into halves. It comes last, and is the longest.
Job halved(Job nest, double x_mm) {
  nest.name += " halved";
  Program program;
  program.go({x_mm, -5});
  program.line({x_mm, nest.size_mm.y + 5});
  CutMove cut = program.take().front();
  cut.id = nest.moves.size();
  nest.moves.push_back(cut);
  ++nest.parts;
  return nest;
}

struct Outcome {
  double cut_s = 0, longest_ms = 0, pieces_s = 0;
  std::size_t corners = 0, parts = 0;
  std::uint64_t operations = 0;
  double blank_mm2 = 0, area_mm2 = 0, piece_area_mm2 = 0, removed_mm2 = 0;
};

/// Of the only thread: what others do on the machine does not count.
double thread_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Outcome run(const Job& job, const Cutter& cutter, int tiles_each_way, std::size_t expected) {
  SheetOptions options;
  options.outline = rectangle_outline({0, 0}, job.size_mm);
  options.expected_moves = expected;
  options.tiles_each_way = tiles_each_way;
  Outcome outcome;
  std::vector<CutReport> reports;
  reports.reserve(job.moves.size());
  const double begin = cpu_s();
  Result<std::unique_ptr<Sheet>> sheet = Sheet::create(options);
  if (!sheet) fail(sheet.error());
  for (const CutMove& move : job.moves) {
    const double before = thread_s();
    (*sheet)->cut(cutter, std::span(&move, 1), reports);
    outcome.longest_ms = std::max(outcome.longest_ms, 1e3 * (thread_s() - before));
  }
  const double cut = cpu_s();
  const std::vector<SheetPiece> pieces = (*sheet)->pieces();
  outcome.cut_s = cut - begin;
  outcome.pieces_s = cpu_s() - cut;
  for (const SheetPiece& piece : pieces) {
    outcome.piece_area_mm2 += piece.area_mm2;
    outcome.parts += piece.is_main() ? 0 : 1;
  }
  for (const CutReport& report : reports) outcome.removed_mm2 += report.removed_mm3;
  outcome.blank_mm2 = (*sheet)->blank_mm3();  // 1 mm thick
  outcome.area_mm2 = (*sheet)->remaining_mm2();
  outcome.corners = (*sheet)->cell_count();
  outcome.operations = (*sheet)->operations();
  return outcome;
}

void check(const Job& job, const Outcome& outcome) {
  const double blank = outcome.blank_mm2;
  if (outcome.parts != job.parts)
    fail(fmt::format("{}: {} parts are free, must be {}", job.name, outcome.parts, job.parts));
  if (std::abs(outcome.piece_area_mm2 + outcome.removed_mm2 - blank) > 1e-9 * blank)
    fail(fmt::format("{}: pieces and kerfs do not add up to the blank", job.name));
}

void measure(const Job& job, const Cutter& cutter, int tiles, std::size_t expected, int runs) {
  Outcome best = run(job, cutter, tiles, expected);
  check(job, best);
  for (int i = 1; i < runs; ++i) {
    const Outcome next = run(job, cutter, tiles, expected);
    best.cut_s = std::min(best.cut_s, next.cut_s);
    best.pieces_s = std::min(best.pieces_s, next.pieces_s);
    best.longest_ms = std::min(best.longest_ms, next.longest_ms);
  }
  const std::string tiling = tiles > 0 ? fmt::format("{0}x{0}", tiles) : "auto";
  fmt::print(
      "{:<15} {:>7}  cut {:8.3f} s  pieces {:6.4f} s  {:7.1f} us/move  longest {:7.3f} ms  "
      "{:>7} operations  {:>8} corners  {:>6} parts  {:.3f} mm2\n",
      job.name, tiling, best.cut_s, best.pieces_s,
      1e6 * best.cut_s / static_cast<double>(job.moves.size()), best.longest_ms, best.operations,
      best.corners, best.parts, best.area_mm2);
  std::fflush(stdout);
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  using namespace kerf;
  int runs = 3;
  bool unsplit = false, nest_only = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--unsplit") {
      unsplit = true;
    } else if (argument == "--nest-only") {
      nest_only = true;
    } else if (argument == "--runs" && i + 1 < argc) {
      runs = std::max(1, std::atoi(argv[++i]));
    } else {
      fail("usage: bench_sheet [--runs N] [--unsplit] [--nest-only]");
    }
  }
  const Result<Cutter> cutter = parse_shape("flat:1.5");
  if (!cutter) fail(cutter.error());
  const Vec2 sheet(3000, 1500), small_sheet(2000, 1000);
  const double pitch_mm = 30;
  const Job nest = nest_of_discs(12371, small_sheet, pitch_mm);
  if (nest_only) {
    measure(nest, *cutter, 0, nest.moves.size(), runs);
    measure(halved(nest, 33 * pitch_mm), *cutter, 0, nest.moves.size(), runs);
    return 0;
  }
  for (const std::size_t moves : {560u, 834u}) {
    const Job job = simple_parts(moves, sheet);
    for (const int tiles : {1, 4, 16, 32, 64}) measure(job, *cutter, tiles, 0, runs);
    measure(job, *cutter, 0, moves, runs);
    measure(job, *cutter, 0, 0, runs);
  }
  for (const int tiles : {4, 16, 32, 64, 128}) measure(nest, *cutter, tiles, 0, runs);
  measure(nest, *cutter, 0, nest.moves.size(), runs);
  measure(halved(nest, 33 * pitch_mm), *cutter, 0, nest.moves.size(), runs);
  if (unsplit) measure(nest, *cutter, 1, 0, 1);
  for (const std::size_t moves : {12'500u, 25'000u, 50'000u, 100'000u, 200'000u}) {
    const double grown = std::sqrt(static_cast<double>(moves) / 12'371);
    measure(nest_of_discs(moves, small_sheet * grown, pitch_mm), *cutter, 0, moves, 1);
  }
  for (const std::size_t moves : {25'000u, 50'000u, 100'000u, 200'000u})
    measure(splines(moves, sheet), *cutter, 0, moves, 1);
  fmt::print("peak memory {:.0f} MB\n", peak_mb());
  return 0;
}
