// twin/process/punch/punch_stage.h - motions of a punch program in, sheet cut: strokes, stations,
// pieces that come free.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tool_use.h"
#include "twin/machine/punch_moves.h"
#include "twin/machine/timeline.h"
#include "twin/machine/turret.h"
#include "twin/process/process.h"
#include "twin/process/punch/punch_checks.h"

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

/// They, as the section of the report.
struct PunchSums final : ProcessSums {
  explicit PunchSums(PunchTotals sums) : totals(std::move(sums)) {}
  void add_json(nlohmann::ordered_json& out) const override;
  std::string text() const override;
  std::string run_text() const override;

  PunchTotals totals;
};

/// A sheet under a punch. The strokes of a motion are cut in one call, unless take_part() divides
/// it: then the sheet has the same shape, and may have other bits. One thread.
class PunchStage final : public Process, public StrokeTaker {
 public:
  /// The workpiece is a sheet.
  PunchStage(ProcessSite& site, TurretPointer turret);

  void go_on_from(const Process& other) override;
  /// Planned paths play no part: a punch strikes where the program says.
  void take(const Motion& motion, const TimedStep& step, std::span<const PathPiece> path) override;
  void take_part(const Motion& motion, const TimedStep& step, double share, bool seen) override;
  void take_seen(const Motion& motion, const TimedStep& step,
                 std::span<const PunchHit> hits) override;
  void note_dragging(const Motion& motion, const TimedStep& step) override;
  void begin_reporting() override;
  void finish(bool whole) override;

  const std::vector<ToolUse>& tools() const override { return uses_; }
  std::span<const FreedPiece> freed() const override { return checks_.freed(); }
  std::shared_ptr<const ProcessSums> sums() const override;
  StrokeTaker* strokes() override { return this; }
  const PunchMoves& moves() const { return moves_; }
  PunchTotals totals() const;

 private:
  void begin(const Motion& motion, const TimedStep& step);
  void strike(const Motion& motion, const TimedStep& step, std::span<const PunchHit> hits);
  void end(const Motion& motion, const TimedStep& step);
  void end_open();
  double punching_s(const Motion& motion, const TimedStep& step) const;
  ToolUse& use_of(const TurretStation& station);

  ProcessSite& site_;
  FeedCheck& feeds_;
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
