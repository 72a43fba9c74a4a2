// twin/cut_stage.h - motions in, workpiece cut: mounts tools, keeps time, checks and cuts, adds up
// what each tool did.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/axis_limits.h"
#include "twin/checks.h"
#include "twin/cut_labels.h"
#include "twin/film_events.h"
#include "twin/finding.h"
#include "twin/kinematics/rotary_checks.h"
#include "twin/length_check.h"
#include "twin/load_meter.h"
#include "twin/motion_moves.h"
#include "twin/program_checks.h"
#include "twin/punch_stage.h"
#include "twin/timeline.h"
#include "twin/tool_use.h"
#include "twin/tools.h"
#include "twin/torch_stage.h"
#include "twin/turret.h"

namespace kerf {

/// Steps of a watched machine are shorter than a cell; its cutting time is counted in grains of
/// this many seconds that removed something.
inline constexpr double kGrain_s = 0.05;

/// The one road from motions to the workpiece. One thread calls it; per move it allocates nothing
/// and hands moves to the model by thousands. Which moves cut: traverses, feeds, arcs and threads
/// with a known start and a known tool. Probes, and moves of a tool of which nothing is known, do
/// not.
class CutStage : private StepSink {
 public:
  CutStage(StockModel& stock, ToolBook& tools, FindingLog& log, const TimelineOptions& options);

  /// The program is a whole one, over this blank: it is told if nothing is cut (nothing-cut).
  void judge_blank(BlankKind blank) { blank_ = blank; }
  /// Before the first motion that moves: where the workpiece lies in the machine.
  void set_frame(const WorkpieceFrame& frame);
  /// What findings are judged by. Before the first motion.
  void check_by(const CheckOptions& options) { checks_.set_options(options); }
  /// From now on moves are named by the numbers of their labels (CutMove::id), instead of one after
  /// the other. Outlives the stage.
  void label_by(CutLabels& labels) { labels_ = &labels; }
  /// The workpiece is a sheet, and the tools are torches: what cuts, and what it is checked for, is
  /// TorchStage's. Before the first motion; not together with label_by() and watch_machine().
  void burn(BeamSettings settings) { torch_.emplace(stock_, book_, log_, std::move(settings)); }
  /// The same of a sheet under a punch: what cuts is PunchStage's.
  void punch(TurretPointer turret) { punch_.emplace(stock_, log_, std::move(turret)); }
  /// Null: it is none that punches.
  PunchStage* punch() { return punch_ ? &*punch_ : nullptr; }
  const PunchStage* punch() const { return punch_ ? &*punch_ : nullptr; }
  /// Of a torch program, all that the motions name from here on.
  void set_materials(std::span<const TorchMaterial> materials);
  /// A sheet's troubles are looked for as if this stage had done what the other one has: what is
  /// free, pierced, gripped. `other` is of the same kind.
  void go_on_from(const CutStage& other);
  /// Of a program that burns; null: it mills.
  TorchStage* torch() { return torch_ ? &*torch_ : nullptr; }
  const TorchStage* torch() const { return torch_ ? &*torch_ : nullptr; }
  /// Motions in program order. They are given to the model as soon as their times are known (which
  /// depend on those behind them), the last ones in finish(). The model may hold some back, too.
  void take(std::span<const Motion> motions);
  /// The motions are those of a machine that is watched, in take_timed(): not the words of a
  /// program, but what sensors tell, in steps shorter than a cell. What lies in the order of the
  /// words (ProgramChecks) is not looked for, cutting time is counted in grains. Before the first
  /// motion.
  void watch_machine() { watched_ = true; }
  /// A motion whose time is known: of a program that has been planned already, or of a machine that
  /// is watched. Not to be mixed with take(), whose motions wait for their times. `path`: what the
  /// machine makes of it, as in StepSink.
  void take_timed(const Motion& motion, const TimedStep& timed,
                  std::span<const PathPiece> path = {});
  /// A motion of the program that a machine which is watched has made, in the parts that
  /// take_timed() was given: what is only to be seen of the whole.
  void check_whole(const Motion& motion, const TimedStep& timed);
  /// All that was taken is in the workpiece.
  void complete() { flush_whole(); }
  /// What comes of a probing move behind all that was taken, which is cut first; the tool in the
  /// spindle is the probe. Not of sheets, and not together with take_timed().
  ProbeAnswer answer(const ProbeQuestion& question);
  /// All that was taken has been given to the model, which may hold some back.
  void hand_over() { flush(); }
  /// What is taken from here on is cut, but not reported on ..
  void hold_reports();
  /// .. until here: tool uses and totals begin with the motion that is taken next; the clock goes
  /// on.
  void release_reports() { report_from_ = taken_; }
  /// The program is over, or stopped before its end (`whole` = false).
  void finish(bool whole = true);
  /// Once `stop` is requested nothing more is cut; looked at before each motion, and within a
  /// motion of many moves. Before the first motion.
  void stop_by(std::stop_token stop) {
    checks_.watch_by({stop, [this](double share) { note_search(share); }});
    stop_ = std::move(stop);
  }
  /// Something that was taken has not been cut for that reason.
  bool stopped() const { return stopped_; }
  /// How much has been cut: the sum of work_of() of the motions. Any thread may look at it.
  void count_work(std::atomic<double>& done) { work_done_ = &done; }
  /// Of a motion, in no unit: its way in mm, and what turns in degrees.
  static double work_of(const Motion& motion);

  /// How the machine turns tool and workpiece; null: it does not.
  const ToolPath* machine_path() const { return machine_moves_.path(); }
  /// The same as the model cuts: while nothing turns if it does not take tilted tools. Null: the
  /// tip is where X Y Z are.
  const ToolPath* model_path() const { return motion_moves_.path(); }
  /// The motion is cut by an upright tool.
  bool is_upright(const Motion& motion) const { return motion_moves_.is_upright(motion); }

  const Timeline& timeline() const { return timeline_; }
  const std::vector<ToolUse>& tools() const {
    return torch_ ? torch_->tools() : punch_ ? punch_->tools() : uses_;
  }
  /// In the spindle, as far as it has been needed; null: none that is known. Until the next call.
  const Cutter* cutter() const {
    return mounted_ && mounted_->cutter ? &*mounted_->cutter : nullptr;
  }

 private:
  /// What is needed when a move's report comes back.
  struct InFlight {
    double duration_s = 0;
    double start_s = 0;   ///< of its motion
    double cut_part = 1;  ///< of its time, where it is one of several moves: LoadMeter
    SourceRef source;
    MotionReach reach;
    std::uint32_t use = 0;  ///< index of ToolUse
    bool feed = false;
    bool measured = false;  ///< its cutting time and rate are in the ToolUse already
    bool spindle_off = false;
  };

  void step(const Motion& motion, const TimedStep& timed, std::span<const PathPiece> path) override;
  void begin_reporting();
  void cut(const Motion& motion, const TimedStep& step);
  void watch_program(const Motion& motion, const TimedStep& step);
  bool stands(const Motion& motion) const;
  void check_standing(const Motion& motion, const TimedStep& step, const CheckedMove& move);
  void report_drawn(const Motion& motion, const TimedStep& step);
  void take_traverse(const Motion& motion, const TimedStep& step);
  void take_feed(const Motion& motion, const TimedStep& step);
  bool mount_for(const Motion& motion);
  void announce(const ResolvedTool& tool, const Motion& motion);
  void report_undefined(const Motion& motion, const TimedStep& step);
  bool divide(const Motion& motion, const TimedStep& step);
  bool comes_near(const Motion& motion) const;
  void note_reach(const Motion& motion);
  void check_turns(const Motion& motion, const TimedStep& step);
  void check_slides(const Motion& motion, const TimedStep& step);
  void report_ignored_turn(const Motion& motion, const TimedStep& step);
  void report_endless_turn(const Motion& motion, const TimedStep& step);
  void report_assumptions(const Motion& motion);
  void report_rotary_faults(const TimedStep& step);
  void report_unknown_place(const Motion& motion, const TimedStep& step);
  void report_outside_stock();
  void check_length(const Motion& motion, const TimedStep& step, bool touches);
  void report_nothing_cut();
  void report_missing_feed(const Motion& motion, const TimedStep& step);
  void note_speed(const Motion& motion, const TimedStep& step);
  void note_contact(const CheckedMove& move);
  void note_depth(const Motion& motion, const TimedStep& step);
  void report_coarse_cells();
  void report_over_feed();
  void push(const Motion& motion, const TimedStep& step, bool spindle_off);
  void push_moves(const Motion& motion, const TimedStep& step, bool spindle_off);
  bool stop_now();
  void note_search(double share);
  void measure(const Motion& motion, const TimedStep& step, InFlight& flight);
  void flush();        ///< hands the collected moves to the model
  void flush_whole();  ///< and completes those that it holds back
  void collect_reports();
  double front_mm_of(const FeedPart& part, const CutReport& report) const;
  void count_feed(ToolUse& use, const InFlight& move, const CutReport& report) const;

  /// Feed moves that ask for more than the axes can do.
  struct OverFeed {
    std::uint64_t count = 0;
    SourceRef source;  ///< the first
    double time_s = 0;
    double programmed_mm_per_min = 0;
    double allowed_mm_per_min = 0;
  };
  /// The deepest place of a tool's feed moves, where they come near the workpiece.
  struct Deepest {
    double tip_z_mm = std::numeric_limits<double>::infinity();
    SourceRef source;  ///< the first of them
    double time_s = 0;
    std::optional<Cutter> cutter;
  };
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};

  StockModel& stock_;
  ToolBook& book_;
  FindingLog& log_;
  bool limits_known_;
  std::string limits_origin_;
  std::shared_ptr<const MachineKinematics> kinematics_;  ///< null: nobody turns anything
  std::array<AxisLimits, kAxisCount> joint_limits_;
  MotionMoves machine_moves_;                ///< as the machine moves
  MotionMoves motion_moves_;                 ///< as the model cuts
  std::optional<RotaryCheck> rotary_check_;  ///< over machine_moves_.path()
  std::vector<RotaryFault> rotary_faults_;
  std::vector<CutMove> divided_;  ///< the present motion
  Timeline timeline_;
  bool timed_ = false;         ///< motions come with their times: take_timed()
  bool watched_ = false;       ///< watch_machine()
  std::uint64_t taken_ = 0;    ///< motions
  std::uint64_t stepped_ = 0;  ///< of them, those whose time is known
  bool holding_ = false;       ///< reports
  std::uint64_t report_from_ = kNever;
  std::span<const PathPiece> path_;  ///< of the present step
  OverFeed over_feed_;
  Checks checks_;
  ProgramChecks program_;
  BlankKind blank_ = BlankKind::kUnjudged;
  bool touched_ = false;          ///< a feed move has met material, whatever the cells have of it
  int contact_looks_ = 0;         ///< for that
  bool probes_ = false;           ///< so far
  std::uint64_t moves_made_ = 0;  ///< motions that move
  std::uint64_t feed_moves_made_ = 0;  ///< of them, those that are no traverses
  /// spindle-off-contact of a program without any S word so far.
  std::optional<FindingLog::Handle> speed_unsaid_;
  bool drawn_told_ = false;  ///< CheckOptions::is_drawn
  LoadMeter load_meter_;
  LengthCheck lengths_;
  FilmEvents films_;
  AxisLimitCheck axis_limits_;
  std::optional<TorchStage> torch_;
  std::optional<PunchStage> punch_;
  std::vector<ToolUse> uses_;
  std::vector<Deepest> deepest_;           ///< one for each of uses_
  const ResolvedTool* mounted_ = nullptr;  ///< null: to be mounted at the next move
  std::uint32_t use_ = 0;
  int spindle_tool_ = 0;
  bool feed_missing_reported_ = false;
  bool turn_reported_ = false;
  bool invented_limits_told_ = false;
  bool assumptions_told_ = false;
  bool machine_place_told_ = false;
  bool unknown_feed_told_ = false;
  std::array<bool, 3> slide_reported_{};  ///< U, V, W
  bool reached_stock_ = false;            ///< a feed move came near the blank, in boxes
  Box feed_bounds_mm_;                    ///< of all feed moves, until then
  std::stop_token stop_;
  bool stopped_ = false;
  std::atomic<double>* work_done_ = nullptr;  ///< may be null
  double work_before_ = 0;                    ///< of the motions before the present one
  double work_of_step_ = 0;
  double work_searched_ = 0;  ///< of the present one, for its contacts
  std::size_t moves_per_cut_;
  std::vector<double> cut_parts_;  ///< of divided_, where it is not one move
  std::vector<CutMove> moves_;
  std::vector<InFlight> in_flight_;  ///< one a move whose report has not come, in order
  std::vector<CutReport> reports_;
  std::uint64_t next_id_ = 0;
  CutLabels* labels_ = nullptr;
};

}  // namespace kerf
