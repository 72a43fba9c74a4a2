// twin/process/turning/turning_stage.h - motions of turning tools: mounts tools, checks and cuts,
// adds up what each tool did.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tool_use.h"
#include "twin/job/tools.h"
#include "twin/machine/timeline.h"
#include "twin/motion/floating_tap.h"
#include "twin/process/fixture_checks.h"
#include "twin/process/part_checks.h"
#include "twin/process/process.h"
#include "twin/process/tool_change_check.h"
#include "twin/process/turning/edge_checks.h"
#include "twin/process/turning/holder_checks.h"
#include "twin/process/turning/holding_checks.h"
#include "twin/process/turning/nose_checks.h"
#include "twin/process/turning/speed_checks.h"
#include "twin/process/turning/stop_checks.h"
#include "twin/process/turning/thread_checks.h"
#include "twin/process/turning/turn_loads.h"
#include "twin/process/turning/turning_checks.h"

namespace kerf {

/// The workpiece turns, tools stand still: traverses, feeds, arcs and threads of a tool that is
/// known are cut as they come. A driven tool (Cutter::live()) mills, the workpiece standing or
/// being an axis: MotionMoves::live_path(). Probes, and moves of a tool of which nothing is known,
/// do not cut.
class TurningStage final : public Process {
 public:
  /// The workpiece is of the model turning.
  explicit TurningStage(ProcessSite& site);

  void take(const Motion& motion, const TimedStep& step, std::span<const PathPiece> path) override;
  void finish(bool whole) override;
  void begin_reporting() override;
  void go_on_from(const Process& other) override;
  void check_by(const CheckOptions& options) override;
  const std::vector<ToolUse>& tools() const override { return uses_; }
  const Cutter* cutter() const override {
    return mounted_ && mounted_->cutter ? &*mounted_->cutter : nullptr;
  }
  std::span<const FallenPiece> fallen() const override { return fallen_; }
  std::vector<CollisionPair> collisions() const override;

 private:
  void take_traverse(const Motion& motion, const TimedStep& step);
  void take_feed(const Motion& motion, const TimedStep& step);
  bool mount_for(const Motion& motion);
  void mount_checks();
  void unmount();
  void check_bodies(const TurnedMove& move);
  CheckedMove finer(const CheckedMove& cut);
  void check_driven(const CheckedMove& cut);
  void check_driven_parts(const CheckedMove& move);
  bool is_driven() const { return mounted_ && mounted_->cutter && mounted_->cutter->live(); }
  bool report_unmilled(const Motion& motion, const TimedStep& step);
  void report_mill_turn(const Motion& motion, const TimedStep& step);
  void report_lost_threads(const Motion& motion, const TimedStep& step);
  void tell_not_modelled(const Motion& motion, const TimedStep& step, std::string text,
                         std::string hint);
  void report_floating_tap(const Motion& motion, const TimedStep& step);
  void report_undefined(const Motion& motion, const TimedStep& step);
  bool stands(const Motion& motion) const;
  bool divide(const Motion& motion, std::vector<CutMove>& moves);
  TurnedMove turned(const Motion& motion, const TimedStep& step) const;
  void cut(const Motion& motion, const TimedStep& step);
  void cut_piece(const Motion& motion, const TimedStep& step, TurnCut& whole);
  TurnCut sum_of_piece() const;
  void note_engagement(const Motion& motion, const TimedStep& step, const TurnCut& piece);
  void take_load(const Motion& motion, const TimedStep& step, const TurnedWay& way, double sine);
  void note_fallen(const Motion& motion, const TimedStep& step);
  void report_nothing_cut();

  ProcessSite& site_;
  StockModel& stock_;
  ToolResolver& resolver_;
  FindingLog& log_;
  ToolChangeCheck changes_;
  TurningChecks checks_;
  HoldingChecks holding_;
  FixtureChecks fixtures_;  ///< what stands beside the workpiece
  FixtureChecks rings_;     ///< what holding_ looks at, for driven tools
  PartChecks parts_;        ///< of driven tools
  HolderChecks holders_;
  EdgeChecks depths_;
  NoseChecks noses_;
  SpeedChecks speeds_;
  StopChecks stops_;
  ThreadChecks threads_;
  TurnLoads loads_;
  std::span<const PathPiece> path_;  ///< of the present motion
  std::vector<CutMove> moves_;       ///< it, as programmed
  std::vector<double> ends_;         ///< of the moves that were made last: ToolPath::moves_of()
  std::vector<CutMove> pieces_;      ///< as the machine runs it
  std::vector<CutMove> finer_;       ///< of a driven tool, divided for what it carries
  std::vector<double> finer_ends_;
  std::vector<CutReport> reports_;
  std::vector<ToolUse> uses_;
  std::vector<FallenPiece> fallen_;
  std::size_t fallen_before_ = 0;          ///< pieces that reports are not about
  const ResolvedTool* mounted_ = nullptr;  ///< null: to be mounted at the next move
  std::optional<Cutter> edges_;            ///< of it, without what holds the insert
  std::size_t use_ = 0;
  int spindle_tool_ = 0;
  std::uint64_t next_id_ = 0;
  std::uint64_t feed_moves_ = 0;
  bool feeds_placed_ = false;  ///< of one it was known where it goes
  bool undefined_ = false;
  bool mill_turn_told_ = false;
  bool unmilled_told_ = false;
  bool threads_told_ = false;
  bool fixtures_told_ = false;
  bool floating_told_ = false;
  SpindleState in_by_ = SpindleState::kStopped;  ///< of the last feed into a hole
  Vec3 in_to_mm_{0};                             ///< where it ended
  FloatingTap floating_;
  double tap_lead_mm_ = 0;  ///< of the present motion, if the tool is a tap; else 0
  bool touched_ = false;
  bool engagement_begun_ = false;  ///< ProcessSite::engagement knows the workpiece
  bool behind_feed_ = false;       ///< the last motion that went anywhere was a feed
};

}  // namespace kerf
