// twin/process/cut_stage.h - motions in, workpiece cut: keeps time, checks what every process has
// in common, and hands motions to the process.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tool_use.h"
#include "twin/job/tools.h"
#include "twin/machine/kinematics/rotary_checks.h"
#include "twin/machine/motion_moves.h"
#include "twin/machine/timeline.h"
#include "twin/process/axis_limits.h"
#include "twin/process/check_options.h"
#include "twin/process/cut_labels.h"
#include "twin/process/dwell_check.h"
#include "twin/process/lost_feed_check.h"
#include "twin/process/process.h"

namespace kerf {

/// The one way from motions to the workpiece, whatever the process makes of them. One thread calls
/// it; per move it allocates nothing, and a motion costs one virtual call.
class CutStage : private StepSink {
 public:
  /// `plan`: of the process; that it fits the workpiece is choose_process()'s word.
  CutStage(StockModel& stock, ToolResolver& tools, FindingLog& log, const TimelineOptions& options,
           const ProcessPlan& plan = *default_process());

  /// The program is a whole one, over this blank: it is told if nothing is cut (nothing-cut).
  void judge_blank(BlankKind blank) { site_.blank = blank; }
  /// Before the first motion that moves: where the workpiece lies in the machine.
  void set_frame(const WorkpieceFrame& frame);
  /// What findings are judged by. Before the first motion.
  void check_by(const CheckOptions& options) { process_->check_by(options); }
  /// From now on moves are named by the numbers of their labels (CutMove::id), instead of one after
  /// the other. Outlives the stage. Not of sheets.
  void label_by(CutLabels& labels) { site_.labels = &labels; }
  /// From now on milling moves are kept as the model gets them. Outlives the stage.
  void keep_moves(KeptMoves& kept) { site_.kept = &kept; }
  /// From now on it is told how milling tools are engaged. Before the first motion; outlives the
  /// stage.
  void log_engagement(EngagementLog& log) { site_.engagement = &log; }
  /// With log_engagement(): from now on it is told what the cuts of milling tools are like. Before
  /// the first motion; outlives the stage.
  void hear_loads(LoadListener& listener) { site_.loads = &listener; }
  /// The workpiece does not keep milling moves by their own numbers: the move of the motion that is
  /// taken next counts as this one, of one with a path each piece as the next one.
  void number_from(std::uint64_t first) { site_.first_id = first; }
  /// Hears of each motion that is reported on, and of what is cut. Before the first motion;
  /// outlives the stage.
  void record_by(MotionRecorder& recorder) { site_.recorder = &recorder; }
  /// Of a torch program, all that the motions name from here on.
  void set_materials(std::span<const TorchMaterial> materials);
  /// Troubles are looked for as if this stage had done what the other one has: what is free,
  /// pierced, gripped. `other` is of the same kind.
  void go_on_from(const CutStage& other) { process_->go_on_from(*other.process_); }
  /// Motions in program order. They are given to the model as soon as their times are known (which
  /// depend on those behind them), the last ones in finish(). The model may hold some back, too.
  void take(std::span<const Motion> motions);
  /// The motions are those of a machine that is watched, in take_timed(): not the words of a
  /// program, but what sensors tell, in steps shorter than a cell. What lies in the order of the
  /// words is not looked for, cutting time is counted in grains. Before the first motion.
  void watch_machine() { site_.watched = true; }
  /// A motion whose time is known: of a program that has been planned already, or of a machine that
  /// is watched. Not to be mixed with take(), whose motions wait for their times. `path`: what the
  /// machine makes of it, as in StepSink.
  void take_timed(const Motion& motion, const TimedStep& timed,
                  std::span<const PathPiece> path = {});
  /// A motion of the program that a machine which is watched has made, in the parts that
  /// take_timed() was given: what is only to be seen of the whole.
  void check_whole(const Motion& motion, const TimedStep& timed);
  /// All that was taken is in the workpiece.
  void complete() { process_->complete(); }
  /// What comes of a probing move behind all that was taken, which is cut first; the tool in the
  /// spindle is the probe. Not of sheets, and not together with take_timed().
  ProbeAnswer answer(const ProbeQuestion& question);
  /// All that was taken has been given to the model, which may hold some back.
  void hand_over() { process_->hand_over(); }
  /// What is taken from here on is cut, but not reported on ..
  void hold_reports();
  /// .. until here: tool uses and totals begin with the motion that is taken next; the clock goes
  /// on.
  void release_reports() { report_from_ = taken_; }
  /// The program goes on behind what is taken: the interpreter has refused a block, or the lines
  /// that are asked for end there. Before finish(), of a program that counts as whole nonetheless.
  void cut_short() { site_.cut_short = true; }
  /// The program is over, or stopped before its end (`whole` = false).
  void finish(bool whole = true);
  /// Once `stop` is requested nothing more is cut; looked at before each motion, and within a
  /// motion of many moves. Before the first motion.
  void stop_by(const std::stop_token& stop);
  /// Something that was taken has not been cut for that reason.
  bool stopped() const { return site_.progress.is_stopped(); }
  /// How much has been cut: the sum of work_of() of the motions. Any thread may look at it.
  void count_work(std::atomic<double>& done) { site_.progress.count_work(done); }
  /// Of a motion, in no unit: its way in mm, and what turns in degrees.
  static double work_of(const Motion& motion);

  /// How the machine turns tool and workpiece; null: it does not.
  const ToolPath* machine_path() const { return machine_moves_.path(); }
  /// The same as the model cuts: while nothing turns if it does not take tilted tools. Null: the
  /// tip is where X Y Z are.
  const ToolPath* model_path() const { return site_.moves.path(); }
  /// The motion is cut by an upright tool.
  bool is_upright(const Motion& motion) const { return site_.moves.is_upright(motion); }

  const Timeline& timeline() const { return timeline_; }
  const Process& process() const { return *process_; }
  const std::vector<ToolUse>& tools() const { return process_->tools(); }
  /// In the spindle, as far as it has been needed; null: none that is known. Until the next call.
  const Cutter* cutter() const { return process_->cutter(); }
  /// Of a process that strikes; null: it does not.
  StrokeTaker* strokes() { return process_->strokes(); }

 private:
  void step(const Motion& motion, const TimedStep& timed, std::span<const PathPiece> path) override;
  void begin_reporting();
  void cut(const Motion& motion, const TimedStep& step, std::span<const PathPiece> path);
  void check_turns(const Motion& motion, const TimedStep& step);
  void check_slides(const Motion& motion, const TimedStep& step);
  void report_ignored_turn(const Motion& motion, const TimedStep& step);
  void report_assumptions(const Motion& motion);
  void report_rotary_faults(const TimedStep& step);
  void report_unknown_place(const Motion& motion, const TimedStep& step);

  static constexpr std::uint64_t kNever = ~std::uint64_t{0};

  ProcessSite site_;
  ProcessTraits traits_;
  std::shared_ptr<const MachineKinematics> kinematics_;  ///< null: nobody turns anything
  std::array<AxisLimits, kAxisCount> joint_limits_;
  MotionMoves machine_moves_;                ///< as the machine moves
  std::optional<RotaryCheck> rotary_check_;  ///< over machine_moves_.path()
  std::vector<RotaryFault> rotary_faults_;
  Timeline timeline_;
  AxisLimitCheck axis_limits_;
  LostFeedCheck lost_feeds_;
  DwellCheck dwells_;
  std::unique_ptr<Process> process_;
  std::uint64_t taken_ = 0;    ///< motions
  std::uint64_t stepped_ = 0;  ///< of them, those whose time is known
  std::uint64_t report_from_ = kNever;
  bool turn_reported_ = false;
  bool invented_limits_told_ = false;
  bool assumptions_told_ = false;
  bool machine_place_told_ = false;
  bool unknown_feed_told_ = false;
  std::array<bool, 3> slide_reported_{};  ///< U, V, W
};

}  // namespace kerf
