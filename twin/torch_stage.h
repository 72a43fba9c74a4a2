// twin/torch_stage.h - motions of a torch program in, sheet cut: beam, kerf, piercing, pieces that
// come free.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interp_bridge/motion.h"
#include "interp_bridge/timing/planner.h"
#include "stock/sheet/sheet.h"
#include "stock/stock_model.h"
#include "twin/beam_settings.h"
#include "twin/finding.h"
#include "twin/kerf_book.h"
#include "twin/timeline.h"
#include "twin/tool_use.h"
#include "twin/tools.h"
#include "twin/torch_checks.h"
#include "twin/torch_moves.h"

namespace kerf {

/// Sums over what is reported on.
struct TorchTotals {
  double cut_mm = 0;  ///< way with the beam on, in X and Y
  std::uint64_t pierces = 0;
  /// Time with the beam on; of a QtPlasmaC machine with what its materials have it hold
  /// (ProgramHolds).
  double beam_s = 0;
};

/// CutStage for sheets: it hands every motion on to here. Moves are given to the sheet one by one,
/// since what comes free must be known by its move; a polygon operation costs some 30 us, a call
/// nothing. In steady state nothing is allocated here. One thread.
class TorchStage {
 public:
  /// `stock`: a Sheet, or what stands before one (StockModel::bare()).
  TorchStage(StockModel& stock, ToolBook& tools, FindingLog& log, BeamSettings settings);

  /// More of them are known now (BeamSettings::materials).
  void set_materials(std::span<const TorchMaterial> materials);
  /// Goes on where another one is, whose sheet is the same.
  void go_on_from(const TorchStage& other);
  /// In program order. `path`: of the machine where it is planned, else empty.
  void take(const Motion& motion, const TimedStep& step, std::span<const PathPiece> path);
  /// Findings, tool uses and sums begin anew with the motion that is taken next.
  void begin_reporting();
  /// The program is over, or stopped before its end (`whole` = false).
  void finish(bool whole);

  const std::vector<ToolUse>& tools() const { return uses_; }
  const TorchTotals& totals() const { return totals_; }
  /// By number; pieces that were cut up afterwards are in it still.
  const std::vector<FreedPiece>& freed() const { return checks_.freed(); }

 private:
  void take_piece(const Motion& motion, const TimedStep& step);
  void burn(const Motion& motion, const TimedStep& step);
  static double burnt_s(const Motion& motion, const TimedStep& step, double burnt_mm);
  void cut(const Motion& motion, const TimedStep& step, bool pierces);
  ToolUse& use_of(const ResolvedTool& kerf, const Motion& motion);
  void announce(const ResolvedTool& kerf, const Motion& motion);
  void report_no_kerf(const ResolvedTool& kerf, const Motion& motion, const TimedStep& step);
  void report_no_beam();
  void report_outside();

  StockModel& stock_;
  FindingLog& log_;
  BeamSettings settings_;
  TorchMoves moves_;
  KerfBook kerfs_;
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
