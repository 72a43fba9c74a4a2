// twin/process/torch/torch_stage.h - motions of a torch program in, sheet cut: beam, kerf,
// piercing, pieces that come free.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "interp_bridge/timing/planner.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tool_use.h"
#include "twin/job/tools.h"
#include "twin/machine/beam_settings.h"
#include "twin/machine/timeline.h"
#include "twin/machine/torch_moves.h"
#include "twin/process/process.h"
#include "twin/process/torch/kerf_resolver.h"
#include "twin/process/torch/torch_checks.h"

namespace kerf {

/// Sums over what is reported on.
struct TorchTotals {
  double cut_mm = 0;  ///< way with the beam on, in X and Y
  std::uint64_t pierces = 0;
  /// Time with the beam on; of a QtPlasmaC machine with what its materials have it hold
  /// (ProgramHolds).
  double beam_s = 0;
};

/// They, as the section of the report.
struct TorchSums final : ProcessSums {
  explicit TorchSums(const TorchTotals& sums) : totals(sums) {}
  void add_json(nlohmann::ordered_json& out) const override;
  std::string text() const override;
  std::string run_text() const override;

  TorchTotals totals;
};

/// A sheet under a beam. Moves are given to the sheet one by one,
/// since what comes free must be known by its move; a polygon operation costs some 30 us, a call
/// nothing. In steady state nothing is allocated here. One thread.
class TorchStage final : public Process {
 public:
  /// The workpiece is a sheet.
  TorchStage(ProcessSite& site, BeamSettings settings);

  void set_materials(std::span<const TorchMaterial> materials) override;
  void go_on_from(const Process& other) override;
  void take(const Motion& motion, const TimedStep& step, std::span<const PathPiece> path) override;
  void begin_reporting() override;
  void finish(bool whole) override;

  const std::vector<ToolUse>& tools() const override { return uses_; }
  std::span<const FreedPiece> freed() const override { return checks_.freed(); }
  std::shared_ptr<const ProcessSums> sums() const override;
  const TorchTotals& totals() const { return totals_; }

 private:
  void take_piece(const Motion& motion, const TimedStep& step);
  void cut(const Motion& motion, const TimedStep& step);
  static double burnt_s(const Motion& motion, const TimedStep& step, double burnt_mm);
  void cut(const Motion& motion, const TimedStep& step, bool pierces);
  ToolUse& use_of(const ResolvedTool& kerf, const Motion& motion);
  void announce(const ResolvedTool& kerf, const Motion& motion);
  void report_no_kerf(const ResolvedTool& kerf, const Motion& motion, const TimedStep& step);
  void report_no_beam();
  void report_outside();

  ProcessSite& site_;
  FeedCheck& feeds_;
  StockModel& stock_;
  FindingLog& log_;
  BeamSettings settings_;
  TorchMoves moves_;
  KerfResolver kerfs_;
  TorchChecks checks_;
  TorchTotals totals_;
  std::vector<ToolUse> uses_;
  const ResolvedTool* kerf_ = nullptr;  ///< of the last motion that burnt
  std::size_t use_ = 0;                 ///< its use
  bool pierced_ = false;                ///< since the beam came on
  bool has_fed_ = false;
  bool has_burnt_ = false;
  bool has_removed_ = false;
  Box burnt_mm_;
  std::vector<CutMove> divided_;  ///< of the present motion
  std::vector<CutReport> reports_;
};

}  // namespace kerf
