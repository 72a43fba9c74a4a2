// twin/process/milling/milling_stage.h - motions of rotating tools: mounts tools, checks and cuts,
// adds up what each tool did.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tool_use.h"
#include "twin/job/tools.h"
#include "twin/machine/timeline.h"
#include "twin/process/fixture_checks.h"
#include "twin/process/milling/checks.h"
#include "twin/process/milling/cut_loads.h"
#include "twin/process/milling/engaged_parts.h"
#include "twin/process/milling/engagement_meter.h"
#include "twin/process/milling/film_events.h"
#include "twin/process/milling/length_check.h"
#include "twin/process/milling/load_meter.h"
#include "twin/process/milling/machine_checks.h"
#include "twin/process/milling/piece_watch.h"
#include "twin/process/milling/program_checks.h"
#include "twin/process/part_checks.h"
#include "twin/process/process.h"
#include "twin/process/tool_change_check.h"

namespace kerf {

/// Steps of a watched machine are shorter than a cell; its cutting time is counted in grains of
/// this many seconds that removed something.
inline constexpr double kGrain_s = 0.05;

/// Per move it allocates nothing and hands moves to the model by thousands. Which moves cut:
/// traverses, feeds, arcs and threads with a known start and a known tool. Probes, and moves of a
/// tool of which nothing is known, do not.
class MillingStage final : public Process {
 public:
  explicit MillingStage(ProcessSite& site);

  void take(const Motion& motion, const TimedStep& step, std::span<const PathPiece> path) override;
  void finish(bool whole) override;
  void begin_reporting() override;
  void hand_over() override;
  void complete() override;
  void check_by(const CheckOptions& options) override {
    checks_.set_options(options);
    parts_.set_blank_guessed(options.blank_guessed);
    parts_.set_clearance(options.collisions.clearance_mm);
    fixtures_.set_obstacles(obstacles_of(options.collisions.fixtures), options.collisions);
    machine_.set_options(options);
    pieces_.set_options(options);
    loads_.set_wish(options.cutting);
    spindle_ = options.collisions.spindle;
    cut_by_shank_ = options.collisions.cut_by_shank;
  }
  void stop_by(const std::stop_token& stop) override;
  const std::vector<ToolUse>& tools() const override { return uses_; }
  std::vector<CollisionPair> collisions() const override;
  const Cutter* cutter() const override {
    return mounted_ && mounted_->cutter ? &*mounted_->cutter : nullptr;
  }
  ProbeAnswer answer(const ProbeQuestion& question) override;
  std::vector<LoosePiece> loose() const override { return pieces_.pieces(); }

 private:
  /// What is needed when a move's report comes back.
  struct InFlight {
    double duration_s = 0;
    double start_s = 0;   ///< of its motion
    double cut_part = 1;  ///< of its time, where it is one of several moves: LoadMeter
    SourceRef source;
    std::uint64_t motion = 0;  ///< ProcessSite::motion
    MotionReach reach;
    std::uint32_t use = 0;  ///< index of ToolUse
    std::uint32_t pass = EngagementLog::kNoPass;
    double engaged_mm = 0, engaged_s = 0;  ///< of it, in material
    double engaged_mm3 = 0;                ///< .. and what stands before the tool there
    double rpm = 0;                        ///< of a spindle that turns
    double feed_per_tooth_mm = 0;          ///< at most; 0: not known
    double mean_per_tooth_mm = 0;
    bool feed = false;
    bool measured = false;  ///< its cutting time and rate are in the ToolUse already
    bool spindle_off = false;
    double way_mm = 0;      ///< of its motion
    std::size_t parts = 0;  ///< of engaged_parts_, those of its motion, with the first of its moves
    bool bounds_parts = false;  ///< it is the only one
    bool reversed = false;      ///< the spindle runs anticlockwise
    bool straight_down = false;
  };
  /// The deepest place of a tool's feed moves, where they come near the workpiece.
  struct Deepest {
    double tip_z_mm = std::numeric_limits<double>::infinity();
    SourceRef source;  ///< the first of them
    double time_s = 0;
    std::optional<Cutter> cutter;
  };

  void watch_program(const Motion& motion, const TimedStep& step);
  bool stands(const Motion& motion) const;
  void check_standing(const Motion& motion, const TimedStep& step, const CheckedMove& move);
  void report_drawn(const Motion& motion, const TimedStep& step);
  void take_traverse(const Motion& motion, const TimedStep& step);
  void count_walls();
  void take_feed(const Motion& motion, const TimedStep& step);
  void mount_parts(const Motion& motion);
  void mount_shank(const Motion& motion);
  /// What the model cuts with.
  const Cutter& cutting() const { return shank_ ? *shank_ : *mounted_->cutter; }
  bool mount_for(const Motion& motion);
  void announce(const ResolvedTool& tool, const Motion& motion);
  void report_undefined(const Motion& motion, const TimedStep& step);
  bool divide(const Motion& motion, const TimedStep& step);
  CheckedMove checked(const Motion& motion, const TimedStep& step) const;
  bool comes_near(const Motion& motion) const;
  void note_reach(const Motion& motion);
  void report_endless_turn(const Motion& motion, const TimedStep& step);
  void report_outside_stock();
  void check_parts(const Motion& motion, const CheckedMove& move);
  void check_pieces(const Motion& motion, const CheckedMove& move, bool upright);
  void check_machine(const Motion& motion, const TimedStep& step);
  void check_length(const Motion& motion, const TimedStep& step, bool touches);
  void report_nothing_cut();
  void note_contact(const CheckedMove& move);
  void note_depth(const Motion& motion, const TimedStep& step);
  void report_coarse_cells();
  void judge_parts(const InFlight& move, const CutReport& report);
  void report_reversed(const InFlight& move, int tool);
  /// Of a way straight down while the spindle runs anticlockwise, that goes up again while it runs
  /// clockwise: a left-hand tap.
  void note_tap(const Motion& m);
  void push(const Motion& motion, const TimedStep& step, bool spindle_off);
  void push_moves(const Motion& motion, const TimedStep& step, bool spindle_off);
  void measure(const Motion& motion, const TimedStep& step, InFlight& flight);
  void engage(const Motion& motion, const TimedStep& step, InFlight& flight);
  void collect_reports();
  double front_mm_of(double way_mm, const CutReport& report) const;
  void count_feed(ToolUse& use, const InFlight& move, const CutReport& report) const;
  void note_teeth(const Motion& motion, const TimedStep& step, InFlight& flight) const;
  void count_chip(ChipLoad& chip, const InFlight& move, const CutReport& report) const;

  ProcessSite& site_;
  StockModel& stock_;
  ToolResolver& resolver_;
  FindingLog& log_;
  std::vector<CutMove> divided_;     ///< the present motion
  std::vector<double> ends_;         ///< CheckedMove::ends of it
  std::span<const PathPiece> path_;  ///< of it
  Checks checks_;
  ToolChangeCheck changes_;
  ProgramChecks program_;
  bool touched_ = false;          ///< a feed move has met material, whatever the cells have of it
  int contact_looks_ = 0;         ///< for that
  bool probes_ = false;           ///< so far
  std::uint64_t moves_made_ = 0;  ///< motions that move
  std::uint64_t feed_moves_made_ = 0;  ///< of them, those that are no traverses
  /// spindle-off-contact of a program without any S word so far.
  std::optional<FindingLog::Handle> speed_unsaid_;
  bool drawn_told_ = false;  ///< CheckOptions::is_drawn
  LoadMeter load_meter_;
  std::optional<EngagementMeter> engagement_;  ///< while anybody wants to know
  CutLoads loads_;
  EngagedParts engaged_parts_{loads_};
  double part_rpm_ = 0, part_mm_per_min_ = 0;  ///< of the present motion
  std::set<int> reversed_told_;  ///< tools that have cut with a spindle that runs anticlockwise
  /// Moves straight down that did, and their tools; motions that are taps; the last such motion,
  /// and where it ended.
  std::vector<std::pair<InFlight, int>> reversed_down_;
  std::set<std::uint64_t> taps_;
  std::optional<std::pair<std::uint64_t, Vec3>> last_down_;
  LengthCheck lengths_;
  FilmEvents films_;
  PartChecks parts_;
  FixtureChecks fixtures_;
  MachineChecks machine_;
  PieceWatch pieces_;
  std::vector<ToolSection> spindle_;
  std::vector<CutMove> finer_;  ///< the present motion, for what is far above the tip
  std::vector<double> finer_ends_;
  bool cut_by_shank_ = false;
  std::optional<Cutter> shank_;  ///< the tool in the spindle, where its shank cuts as well
  std::set<int> shank_told_;     ///< tools whose shank should cut, and does not
  double nose_mm_ = 0;           ///< of the spindle above the tip, by the tool length offset
  std::vector<ToolUse> uses_;
  std::vector<Deepest> deepest_;           ///< one for each of uses_
  const ResolvedTool* mounted_ = nullptr;  ///< null: to be mounted at the next move
  std::uint32_t use_ = 0;
  double beside_cells_mm3_ = 0;  ///< StockModel::beside_cells_mm3(), when the tool was mounted
  int spindle_tool_ = 0;
  bool reached_stock_ = false;  ///< a feed move came near the blank, in boxes
  Box feed_bounds_mm_;          ///< of all feed moves, until then
  std::size_t moves_per_cut_;
  std::vector<double> cut_parts_;  ///< of divided_, where it is not one move
  std::vector<CutMove> moves_;
  InFlight flight_;                  ///< the one that is pushed now
  std::vector<InFlight> in_flight_;  ///< one a move whose report has not come, in order
  std::vector<CutReport> reports_;
  std::uint64_t next_id_ = 0;
};

}  // namespace kerf
