// bench_punch: how fast a sheet is punched. Checks its results first, then times.
//
//   bench_punch [--runs N]
//
// Generated programs on a sheet of 2500 x 1250 mm, by the way of a dry run (PunchStage with its
// checks): 560 single strokes of four shapes, and 834 moves of which 498 nibble lines and arcs. CPU
// seconds of one thread, the least of N runs (default 5).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "stock/sheet/punch_hits.h"
#include "stock/sheet/punch_shape.h"
#include "stock/sheet/sheet.h"
#include "twin/job/stock_choice.h"
#include "twin/process/cut_stage.h"
#include "twin/process/punch/punch_plan.h"
#include "twin/process/punch/punch_stage.h"

namespace kerf {
namespace {

constexpr Vec2 kSheet_mm{2500, 1250};
constexpr double kPitch_mm = 4;
constexpr int kWindows = 166;

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_punch: {}\n", why);
  std::exit(2);
}

double thread_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

TurretPointer turret() {
  auto out = std::make_shared<Turret>();
  int number = 0;
  for (const char* const shape : {"round:10", "square:12", "obround:24:8", "rectangle:30:5"}) {
    Result<PlaneOutline> outline = parse_punch_shape(shape, 0.005);
    if (!outline) fail(outline.error());
    Result<Cutter> punch = punch_cutter(fmt::format("punch:{}", shape), *outline);
    if (!punch) fail(punch.error());
    ++number;
    out->stations.emplace(number, TurretStation{number, "", shape, std::move(*punch), 0, false, 0});
  }
  out->nibble_pitch_mm = kPitch_mm;
  out->clamps = {{{300, -80}, {420, 15}, 5}, {{2000, -80}, {2120, 15}, 5}};
  return out;
}

class Program {
 public:
  void go(const Vec2& to) { step(MotionKind::kTraverse, to); }
  void feed(const Vec2& to) { step(MotionKind::kFeed, to); }
  void half_circle(const Vec2& center) {
    step(MotionKind::kArc, 2.0 * center - Vec2(at_.to_mm));
    motions_.back().arc = ArcGeometry{Vec3(center, 0), {0, 0, 1}, kPi};
  }
  void tool(int number) {
    at_.tool = number;
    step(MotionKind::kToolChange, Vec2(at_.to_mm));
  }
  void punch(bool on) {
    at_.torch.spindles_on = on ? 1 : 0;
    step(MotionKind::kSignal, Vec2(at_.to_mm));
  }
  const std::vector<Motion>& motions() const { return motions_; }

 private:
  void step(MotionKind kind, const Vec2& to) {
    Motion m = at_;
    m.kind = kind;
    m.from_mm = at_.to_mm;
    m.to_mm = at_.to_mm = Vec3(to, 0);
    m.feed_mm_per_min = 3000;
    m.source.line = static_cast<std::uint32_t>(motions_.size() + 1);
    motions_.push_back(m);
  }
  Motion at_;
  std::vector<Motion> motions_;
};

/// 28 x 20 places, a station for each quarter.
Program single_strokes() {
  Program program;
  for (int i = 0; i < 560; ++i) {
    if (i % 140 == 0) program.tool(i / 140 + 1);
    program.go({60.0 + 85 * (i % 28), 60.0 + 58 * (i / 28)});
    program.punch(true);
    program.punch(false);
  }
  return program;
}

/// 166 slots and as many windows of 40 mm, whose slugs come free: 830 moves, and 4 beside them.
Program nibbling() {
  Program program;
  program.tool(1);
  for (int i = 0; i < kWindows; ++i) {
    const Vec2 corner(50.0 + 118 * (i % 20), 50.0 + 116 * (i / 20));
    program.go(corner);
    program.punch(true);
    program.feed(corner + Vec2(60, 0));
    program.punch(false);
    program.go(corner + Vec2(70, 50));
    program.punch(true);
    program.half_circle(corner + Vec2(50, 50));
    program.half_circle(corner + Vec2(50, 50));
    program.punch(false);
  }
  for (int i = 0; i < 4; ++i) program.go({i % 2 * 2000.0, 0});
  return program;
}

struct Outcome {
  double cut_s = 0;
  PunchTotals totals;
  double punched_mm2 = 0;
  std::size_t freed = 0, findings = 0;
};

Outcome run(const Program& program, const TurretPointer& press) {
  const double begin = thread_s();
  SheetOptions options;
  options.outline = rectangle_outline({0, 0}, kSheet_mm);
  Result<std::unique_ptr<Sheet>> sheet = Sheet::create(options);
  if (!sheet) fail(sheet.error());
  ToolResolver resolver({}, stock_model(StockKind::kSheet).can_cut);
  FindingLog log;
  CutStage stage(**sheet, resolver, log, TimelineOptions{}, *punch_process(press));
  stage.take(program.motions());
  stage.finish();
  Outcome outcome;
  outcome.cut_s = thread_s() - begin;
  outcome.totals = dynamic_cast<const PunchStage&>(stage.process()).totals();
  outcome.punched_mm2 = kSheet_mm.x * kSheet_mm.y - (*sheet)->remaining_mm2();
  outcome.freed = stage.process().freed().size();
  outcome.findings = log.total();
  return outcome;
}

void measure(const std::string& name, const Program& program, std::uint64_t hits, std::size_t freed,
             double expected_mm2, int runs) {
  const TurretPointer press = turret();
  Outcome best = run(program, press);
  if (best.totals.hits != hits) fail(fmt::format("{}: {} hits", name, best.totals.hits));
  if (best.freed != freed) fail(fmt::format("{}: {} pieces are free", name, best.freed));
  if (best.findings != 0) fail(fmt::format("{}: {} findings", name, best.findings));
  if (expected_mm2 > 0 && std::abs(best.punched_mm2 - expected_mm2) > 1e-4 * expected_mm2)
    fail(fmt::format("{}: {} mm2 are punched, must be {}", name, best.punched_mm2, expected_mm2));
  for (int i = 1; i < runs; ++i) best.cut_s = std::min(best.cut_s, run(program, press).cut_s);
  fmt::print("{:<22} {:>5} motions {:>6} hits  {:>7.1f} ms  {:>6.1f} us a hit\n", name,
             program.motions().size(), hits, 1e3 * best.cut_s,
             1e6 * best.cut_s / static_cast<double>(hits));
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  int runs = 5;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--runs" && i + 1 < argc) {
      runs = std::max(1, std::atoi(argv[++i]));
    } else {
      fmt::print(stderr, "bench_punch [--runs N]\n");
      return 2;
    }
  }
  using kerf::kPi;
  const double shapes = kPi * 25 + 144 + (16 * 8 + kPi * 16) + 150;
  kerf::measure("560 single strokes", kerf::single_strokes(), 560, 0, 140 * shapes, runs);
  // A slot of 60 mm: 16 strokes. A half circle of 62.8 mm: 15 steps and a rest; the first begins
  // with M3's stroke, the second where that ends.
  const std::uint64_t window = 1 + 16 + 16;
  kerf::measure("834 moves, nibbling", kerf::nibbling(), kerf::kWindows * (16 + window),
                kerf::kWindows, 0, runs);
  return 0;
}
