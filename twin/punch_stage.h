// twin/punch_stage.h - motions of a punch program in, sheet cut: strokes, stations, pieces that
// come free.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/finding.h"
#include "twin/punch_checks.h"
#include "twin/punch_moves.h"
#include "twin/timeline.h"
#include "twin/tool_use.h"
#include "twin/turret.h"

namespace kerf {

/// What one station did.
struct StationUse {
  int station = 0;
  std::string name, shape;
  std::uint64_t hits = 0;
};

/// Sums over what is reported on.
struct PunchTotals {
  std::uint64_t hits = 0;
  double nibbled_mm = 0;  ///< way of the feeds on which the punch nibbles
  std::uint64_t regrips = 0;
  std::vector<StationUse> stations;  ///< in order of use
};

/// CutStage for sheets under a punch, as TorchStage is for torches: it is handed every motion. The
/// strokes of a motion are cut in one call, unless take_part() divides it: then the sheet has the
/// same shape, and may have other bits. One thread.
class PunchStage {
 public:
  /// `stock`: a Sheet, or what stands before one (StockModel::bare()).
  PunchStage(StockModel& stock, FindingLog& log, TurretPointer turret);

  /// Goes on where another one is, whose sheet is the same.
  void go_on_from(const PunchStage& other);
  /// In program order. Planned paths play no part: a punch strikes where the program says.
  void take(const Motion& motion, const TimedStep& step) { take_part(motion, step, 1); }
  /// The same of a motion that a machine is still on: what comes up to `share` of its way. Again
  /// with a greater share, or take(), is the same motion. `seen` = false: nobody has seen the
  /// machine come so far; the clamps go along, nothing is struck.
  void take_part(const Motion& motion, const TimedStep& step, double share, bool seen = true);
  /// Strokes that have been seen, and are no program's: `motion` says which tool, line and time.
  void take_seen(const Motion& motion, const TimedStep& step, std::span<const PunchHit> hits);
  /// punch-down, of a machine without a program.
  void note_dragging(const Motion& motion, const TimedStep& step);
  /// Findings, tool uses and sums begin anew with the motion that is taken next.
  void begin_reporting();
  /// The program is over, or stopped before its end (`whole` = false).
  void finish(bool whole);

  const PunchMoves& moves() const { return moves_; }
  const std::vector<ToolUse>& tools() const { return uses_; }
  PunchTotals totals() const;
  /// By number; pieces that were cut up afterwards are in it still.
  const std::vector<FreedPiece>& freed() const { return checks_.freed(); }

 private:
  void begin(const Motion& motion, const TimedStep& step);
  void strike(const Motion& motion, const TimedStep& step, std::span<const PunchHit> hits);
  void end(const Motion& motion, const TimedStep& step);
  void end_open();
  double punching_s(const Motion& motion, const TimedStep& step) const;
  ToolUse& use_of(const TurretStation& station);

  StockModel& stock_;
  TurretPointer turret_;
  PunchMoves moves_;
  PunchChecks checks_;
  /// The last motions, for PunchMoves::hits(): motion n at n % size.
  std::array<Motion, 2 * PunchMoves::kLookBack> recent_;
  std::size_t taken_ = 0;
  std::vector<PunchHit> hits_;    ///< of the present motion
  std::size_t struck_ = 0;        ///< of these
  bool is_open_ = false;          ///< more of the present motion is to come
  std::vector<CutMove> strokes_;  ///< of the present motion, as far as they have been cut
  double removed_mm3_ = 0;        ///< by them
  std::vector<CutReport> reports_;
  std::vector<ToolUse> uses_;
  PunchTotals totals_;
  std::uint64_t regrips_before_ = 0;  ///< reports began
  bool has_struck_ = false;
  bool has_moved_ = false;
};

}  // namespace kerf
