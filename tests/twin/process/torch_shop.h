// tests/twin/process/torch_shop.h - sheets cut by motions that are made by hand.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "stock/sheet/sheet.h"
#include "tests/twin/process/motions.h"
#include "twin/job/stock_choice.h"
#include "twin/process/cut_stage.h"
#include "twin/process/torch/torch_plan.h"
#include "twin/report/sheet_report.h"

namespace kerf::test {

/// 200 x 100 x 3 mm from 0, 0.
inline std::unique_ptr<Sheet> sheet_200() {
  SheetOptions options;
  options.outline = rectangle_outline({0, 0}, {200, 100});
  options.bottom_mm = -3;
  options.top_mm = 0;
  return std::move(Sheet::create(options).value());
}

/// Tool 1 is a torch.
inline ToolSources torch_of(const std::string& shape) {
  ToolSources sources;
  sources.arguments.push_back(std::move(parse_tool_argument("1=" + shape).value()));
  return sources;
}

/// The torch in the spindle, the head at X5 Y5 above the sheet.
inline MotionList torch_program() {
  MotionList program;
  program.at({5, 5, 2}).tool(1);
  return program;
}

/// Closed, from its corner, by a lead-in of 3 mm from the left; anticlockwise. Six lines.
inline MotionList& square(MotionList& program, Vec2 corner, double edge, double z = 1) {
  const double x = corner.x, y = corner.y;
  program.traverse({x - 3, y, z}).spindle(true);
  program.feed({x, y, z}).feed({x + edge, y, z}).feed({x + edge, y + edge, z});
  program.feed({x, y + edge, z}).feed({x, y, z}).spindle(false);
  return program;
}

/// A program cut as a dry run does.
class TorchShop {
 public:
  explicit TorchShop(std::span<const Motion> motions, const BeamSettings& settings = {},
                     ToolSources tools = torch_of("kerf:2"))
      : sheet_(sheet_200()),
        resolver_(std::move(tools), stock_model(StockKind::kSheet).can_cut),
        stage_(*sheet_, resolver_, log_, timing_of(settings), *torch_process(settings)) {
    stage_.set_materials(settings.materials);
    stage_.take(motions);
    stage_.finish();
  }

  const Sheet& sheet() const { return *sheet_; }
  const std::vector<Finding>& findings() const { return log_.kept(); }
  std::vector<std::string> ids() const {
    std::vector<std::string> out;
    for (const Finding& finding : log_.kept()) out.emplace_back(to_string(finding.id));
    return out;
  }
  const CutStage& stage() const { return stage_; }
  SheetReport report() const { return sheet_report(*sheet_, stage_.process(), 8000); }
  double kerf_mm2() const { return 200 * 100 - sheet_->remaining_mm2(); }

 private:
  static TimelineOptions timing_of(const BeamSettings& settings) {
    TimelineOptions timing;
    timing.holds = torch_process(settings)->holds();
    return timing;
  }

  std::unique_ptr<Sheet> sheet_;
  FindingLog log_;
  ToolResolver resolver_;
  CutStage stage_;
};

}  // namespace kerf::test
