// tests/twin/live/cutter_shop.h - a block, its cutters, and a LiveCutter that watches who mills it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "stock/cutter/shape_spec.h"
#include "stock/zmap/zmap.h"
#include "tests/twin/live/live_shop.h"
#include "twin/live/live_cutter.h"
#include "twin/process/cut_stage.h"

namespace kerf {

inline std::unique_ptr<ZMap> block() {
  ZMapOptions options;
  options.blank = parse_blank("box:0,0,-10:40,40,0").value();
  options.cell_mm = 0.1;
  return std::move(ZMap::create(options).value());
}

inline ToolSources cutters() {
  ToolSources sources;
  sources.arguments.push_back(std::move(parse_tool_argument("1=flat:4").value()));
  sources.arguments.push_back(std::move(parse_tool_argument("2=ball:6").value()));
  return sources;
}

/// The workpiece of a dry run.
inline std::unique_ptr<ZMap> dry_run(std::span<const Motion> program) {
  auto stock = block();
  ToolResolver resolver(cutters(), ZMap::can_cut);
  FindingLog log;
  CutStage stage(*stock, resolver, log, TimelineOptions{});
  stage.take(program);
  stage.finish();
  return stock;
}

/// A machine that is watched.
class Watch {
 public:
  explicit Watch(LiveCutOptions options = {}, const MotionList* program = nullptr)
      : stock_(block()) {
    options.frame.tool_length = length;
    std::unique_ptr<Program> listed;
    if (program) listed = std::make_unique<ListedProgram>(program->list());
    options.wait_for_program = true;
    cutter_ = std::make_unique<LiveCutter>(*stock_, cutters(), log_, options, std::move(listed));
  }
  void run(const RunningMachine& machine, double rate_hz, bool with_line = false) {
    const double end_s = machine.duration_s();
    for (int i = 0; i <= static_cast<int>(end_s * rate_hz) + 1; ++i) {
      const double t = std::min(end_s, i / rate_hz);
      cutter_->take(machine.sample(t, with_line), i / rate_hz, false);
      cutter_->look();
      for (AheadWarning& warning : cutter_->take_warnings()) {
        warnings.push_back({std::move(warning), t});
      }
    }
    cutter_->finish();
  }
  void see(Vec3 tip, double t_s, int tool = 1, bool lost = false,
           double rpm = std::numeric_limits<double>::quiet_NaN()) {
    AxisSample sample;
    for (int i = 0; i < 3; ++i) sample.set(static_cast<std::size_t>(i), tip[i]);
    sample.tool = tool;
    sample.spindle_rpm = rpm;
    cutter_->take(sample, t_s, lost);
  }
  std::vector<AheadWarning> look_ahead() {
    cutter_->look();
    return cutter_->take_warnings();
  }
  double removed_mm3() {
    cutter_->look();
    return stock_->blank_mm3() - stock_->remaining_mm3();
  }
  std::vector<FindingId> ids() const {
    std::vector<FindingId> out;
    for (const Finding& f : log_.kept()) out.push_back(f.id);
    return out;
  }
  LiveCutter& cutter() { return *cutter_; }
  const ZMap& stock() const { return *stock_; }
  const FindingLog& log() const { return log_; }

  /// Positions are those of the tip.
  static inline ToolLengthFrom length = ToolLengthFrom::kNone;
  struct Told {
    AheadWarning warning;
    double at_s;
  };
  std::vector<Told> warnings;

 private:
  std::unique_ptr<ZMap> stock_;
  FindingLog log_;
  std::unique_ptr<LiveCutter> cutter_;
};

inline double worst_difference_mm(const ZMap& a, const ZMap& b) {
  double worst = 0;
  for (int j = 0; j < a.ny(); ++j) {
    for (int i = 0; i < a.nx(); ++i) {
      worst = std::max(worst, std::abs(static_cast<double>(a.height_mm(i, j) - b.height_mm(i, j))));
    }
  }
  return worst;
}

inline MotionList pocket() {
  MotionList program;
  program.at({-5, -5, 5}).tool(1).spindle(true).feed_rate(3000);
  program.traverse({10, 10, 5}).feed({10, 10, -2});
  for (int i = 0; i < 8; ++i) {
    program.feed({i % 2 ? 10.0 : 30.0, 10 + 2.0 * i, -2});
    program.feed({i % 2 ? 10.0 : 30.0, 12 + 2.0 * i, -2});
  }
  program.arc({30, 26, -4}, {20, 26, -2}, {0, 0, 1}, 2 * kPi + kPi);
  program.traverse({30, 26, 5}).tool(2).spindle(true);
  program.traverse({20, 20, 5}).feed({20, 20, -5}).feed({35, 35, -3}).traverse({35, 35, 5});
  return program;
}

/// A slot, one beside it, and a rapid back through the first.
inline MotionList two_slots() {
  MotionList program;
  program.at({5, 20, 5}).tool(1).spindle(true).feed_rate(900);
  program.traverse({5, 20, 3}).feed({5, 20, -3}).feed({35, 20, -3}).traverse({35, 20, 5});
  program.traverse({5, 30, 5}).feed({5, 30, -3}).feed({35, 30, -3}).traverse({35, 30, 5});
  program.traverse({35, 20, 5}).traverse({35, 20, -3}).traverse({5, 20, -3}).traverse({5, 20, 5});
  return program;
}

}  // namespace kerf
