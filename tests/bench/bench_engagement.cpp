// bench_engagement: how near the looks of --engagement come to exact geometry, along a program.
//
//   bench_engagement PROGRAM --stock SPEC --tool SHAPE [--cell MM] [--looks N] [--dense MM]
//   [--brief 1]
//
// One tool cuts all moves. N feed moves (default 100), evenly spread, are looked at in their
// middle, before they are cut, and asked about by brute force (engagement_oracle.h). --dense: what
// is removed, in cells of that size, too; fails where the two are apart by more than 1e-4.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "interp_bridge/program.h"
#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/twin/process/milling/engagement_oracle.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/milling/engagement_scan.h"

namespace kerf {
namespace {

struct Wish {
  std::string program, stock, tool;
  double cell_mm = 0.1, dense_mm = 0;
  std::size_t looks = 100;
  bool is_brief = false;
};

[[noreturn]] void fail(const std::string& why) {
  fmt::print(stderr, "bench_engagement: {}\n", why);
  std::exit(2);
}

struct Step {
  CutMove move;
  bool feed = false;
};

std::vector<Step> steps_of(const Wish& wish) {
  ProgramOptions options;
  options.path = wish.program;
  Diagnostics diagnostics;
  const std::unique_ptr<Program> program = Program::open(options, diagnostics);
  std::vector<Step> steps;
  if (program) {
    program->run(
        [&](std::span<const Motion> batch) {
          for (const Motion& m : batch) {
            if ((!is_feed(m) && !is_traverse(m)) || !m.start_known || stands_still(m)) continue;
            steps.push_back({cut_move_from(m, steps.size()), is_feed(m)});
          }
          return true;
        },
        {}, diagnostics);
  }
  for (const Diagnostic& d : diagnostics) fmt::print(stderr, "{}", to_string(d));
  if (steps.empty()) fail(wish.program + ": no moves");
  return steps;
}

std::unique_ptr<ZMap> block_of(const Wish& wish, double cell_mm) {
  ZMapOptions options;
  options.blank = parse_blank(wish.stock).value();
  options.cell_mm = cell_mm;
  auto made = ZMap::create(options);
  if (!made) fail(made.error());
  return std::move(made.value());
}

/// As one piece of the blank is removed as another one: 1e-4 of it.
int compare_volumes(const Wish& wish, const Cutter& cutter, const std::vector<Step>& steps,
                    double removed_mm3) {
  constexpr double kMostApart = 1e-4;
  const std::unique_ptr<ZMap> dense = block_of(wish, wish.dense_mm);
  const double blank_mm3 = dense->remaining_mm3();
  std::vector<CutReport> reports;
  for (const Step& step : steps) {
    dense->cut(cutter, {&step.move, 1}, reports);
    reports.clear();
  }
  dense->finish(reports);
  const double dense_mm3 = blank_mm3 - dense->remaining_mm3();
  const double apart = std::abs(removed_mm3 / dense_mm3 - 1);
  fmt::print("removed {:.3f} mm3, in cells of {} mm {:.3f}: {:.2e} apart\n", removed_mm3,
             wish.dense_mm, dense_mm3, apart);
  return apart <= kMostApart ? 0 : 1;
}

int run(const Wish& wish) {
  const Cutter cutter = parse_shape(wish.tool).value();
  const std::vector<Step> steps = steps_of(wish);
  const std::unique_ptr<ZMap> map = block_of(wish, wish.cell_mm);
  const double blank_mm3 = map->remaining_mm3();
  map->keep_cut_ids(true);
  EngagementOracle oracle(map->bounds_mm());
  PastWays ways;
  ways.mount(cutter);
  EngagementScan scan;
  EngagementErrors errors;
  std::vector<CutReport> reports;
  std::size_t engaged = 0;
  double looked_s = 0;
  const double each = static_cast<double>(steps.size()) / static_cast<double>(wish.looks);
  double next = 0.5 * each;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const Step& step = steps[n];
    const bool sideways = step.move.arc || Vec2(step.move.to_mm) != Vec2(step.move.from_mm);
    if (static_cast<double>(n) >= next && step.feed && sideways &&
        EngagementScan::takes(cutter, step.move)) {
      next += each;
      const std::optional<HeightGrid> heights = map->present_heights();
      EngagementScan::Look asked;
      asked.at = 0.5, asked.owners = map.get(), asked.ways = &ways;
      asked.is_brief = wish.is_brief;
      const auto begun = std::chrono::steady_clock::now();
      const EngagementLook look = scan.look_ahead(*heights, cutter, step.move, asked);
      looked_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
      const EngagementTruth truth = oracle.look(cutter, step.move, 0.5, 180, 40);
      const double before = errors.most;
      errors.add(look, truth);
      engaged += truth.arc > 0 ? 1 : 0;
      if (errors.most > before && before > 2 * kOracleDegree)
        fmt::print("move {}: {:.1f} ({:.1f}) from {:.1f} ({:.1f}) to {:.1f} ({:.1f})\n", n,
                   look.angle_rad / kOracleDegree, truth.arc / kOracleDegree,
                   look.entry_rad / kOracleDegree, truth.entry / kOracleDegree,
                   look.exit_rad / kOracleDegree, truth.exit / kOracleDegree);
    }
    map->cut(cutter, {&step.move, 1}, reports);
    map->finish(reports);
    reports.clear();
    ways.add(step.move);
    oracle.add(cutter, step.move);
  }
  fmt::print("{}, {}, cells of {} mm: {} engaged; {}; {:.1f} us a look\n", wish.program, wish.tool,
             wish.cell_mm, engaged, errors.text(), 1e6 * looked_s / errors.looks);
  if (wish.dense_mm <= 0) return 0;
  return compare_volumes(wish, cutter, steps, blank_mm3 - map->remaining_mm3());
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  kerf::Wish wish;
  if (argc < 2) kerf::fail("which program?");
  wish.program = argv[1];
  for (int i = 2; i + 1 < argc; i += 2) {
    const std::string option = argv[i], value = argv[i + 1];
    if (option == "--stock") wish.stock = value;
    if (option == "--tool") wish.tool = value;
    if (option == "--cell") wish.cell_mm = std::atof(value.c_str());
    if (option == "--dense") wish.dense_mm = std::atof(value.c_str());
    if (option == "--brief") wish.is_brief = value != "0";
    if (option == "--looks") wish.looks = static_cast<std::size_t>(std::atoi(value.c_str()));
  }
  if (!kerf::parse_blank(wish.stock) || !kerf::parse_shape(wish.tool))
    kerf::fail("--stock SPEC --tool SHAPE");
  return kerf::run(wish);
}
