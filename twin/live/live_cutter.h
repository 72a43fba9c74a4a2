// twin/live/live_cutter.h - positions of a machine in, workpiece cut: with a program along its
// path, without one along the straight line from sample to sample.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "machine_io/position_source.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tools.h"
#include "twin/live/late_join.h"
#include "twin/live/live_cut_options.h"
#include "twin/live/load_watch.h"
#include "twin/live/look_ahead.h"
#include "twin/live/machine_watch.h"
#include "twin/live/path_matcher.h"
#include "twin/live/path_watch.h"
#include "twin/live/punch_follower.h"
#include "twin/live/source_watch.h"
#include "twin/live/spindle_memory.h"
#include "twin/live/tool_state.h"
#include "twin/live/way_cutter.h"
#include "twin/process/cut_labels.h"
#include "twin/process/cut_stage.h"
#include "twin/report/live_facts.h"

namespace kerf {

/// Leads each sample through those who have a job of it:
///
///     SourceWatch    does it count, and what lies between it and the one before
///     PathMatcher    where on the program's path is it; LateJoin: it is found for the first time
///     WayCutter      what is removed on the way; PunchFollower: what is struck
///     PathWatch, MachineWatch    which findings follow
///     LookAhead      what the program would do next, in a thread of its own
///
/// Itself it keeps what all of them need: the reading before, and the order in which they come.
///
/// One thread. Deterministic: the same samples with the same times give the same workpiece, as
/// long as the program is waited for. In a model that takes tilted tools a way is cut when it has
/// lasted for DrivenRun::kLongest_s, ends or turns off; in others at once.
class LiveCutter {
 public:
  /// `program` may be null. The references must outlive the cutter.
  LiveCutter(StockModel& stock, const ToolSources& tools, FindingLog& log, LiveCutOptions options,
             std::unique_ptr<Program> program);
  LiveCutter(const LiveCutter&) = delete;
  LiveCutter& operator=(const LiveCutter&) = delete;

  /// For a workpiece that keeps cut ids: see CutStage. Before the first sample.
  void label_by(CutLabels& labels) { cutter_.stage().label_by(labels); }
  /// The next sample, `t_s` after the first by one clock. `lost`: others are known to be missing
  /// before it. One that may be wild waits for the next.
  void take(const AxisSample& sample, double t_s, bool lost);
  /// The workpiece is up to date with the samples but for a way that is still short, and the
  /// program ahead has been looked at.
  void look();
  /// So are the workpiece's snapshots. When it or look() is called makes no difference to the
  /// workpiece in the end.
  void hand_over() { cutter_.stage().hand_over(); }
  /// All that was taken is in the workpiece, a way that is still short, too.
  void settle();
  void finish();

  /// The program that it was made with, read from another start, before the machine has been found
  /// on it.
  void read_again(std::unique_ptr<Program> program,
                  std::function<std::unique_ptr<Program>()> reopen);
  /// The workpiece was another cutter's before, which has done with it what goes before.
  void go_on_from(const LiveCutter& other) { cutter_.stage().go_on_from(other.stage()); }
  /// What the other one has learnt of the spindle's load counts here as well.
  void know_loads_of(const LiveCutter& other) { loads_.go_on_from(other.loads_); }
  const LoadWatch& loads() const { return loads_; }
  /// Where the machine was before the first sample: it is seen, and not counted.
  void begin_at(const AxisSample& sample, double t_s) {
    take(sample, t_s, false);
    facts_ = {};
  }
  /// The machine does not run the program (any more): it is on no path, and off none.
  void set_running(bool runs) { runs_ = runs; }
  /// It is not known whether it still does: a tip that is not on the path is not told of.
  void set_doubtful(bool doubtful) { doubtful_ = doubtful; }
  /// Off: nothing is told ahead, at no cost.
  void set_looks_ahead(bool looks) { look_ahead_.set_on(looks); }
  /// The machine has been on the program's path.
  bool found() const { return matcher_.follower().found(); }
  /// And has come to its end.
  bool finished() const { return matcher_.finished(); }
  /// What is left of the program are ways home: no feed, and of a process that strikes nothing at
  /// all.
  bool has_cut_all() const;
  /// It has worked in the blank, and never on the program's path.
  bool is_foreign() const { return path_watch_.is_foreign(); }
  /// It says that it runs a line of the program, and is not there.
  bool is_astray() const { return path_watch_.is_off_path(); }
  /// Line of the motion on which the machine was found first; 0: it has not been.
  std::uint32_t first_line() const { return first_line_; }

  const LiveFacts& facts() const { return facts_; }
  const ToolState& place() const { return place_; }
  const CutStage& stage() const { return cutter_.stage(); }
  const ProgramAhead* program() const { return matcher_.program(); }
  /// Where a program would begin that the machine starts there (LiveFrame::machine_place_of()).
  /// Nothing if the sample does not tell.
  std::optional<std::array<double, 9>> start_at(const AxisSample& sample) const;
  /// Where the workpiece lies in the machine.
  const WorkpieceFrame& work() const { return matcher_.work(); }
  /// What the look-ahead has found since the last call.
  std::vector<AheadWarning> take_warnings() { return look_ahead_.take_warnings(); }

 private:
  void follow_program(std::unique_ptr<Program> program);
  void take_sound(const AxisSample& sample, double t_s, bool lost);
  std::optional<Reading> see(const AxisSample& sample, double t_s);
  PathMatch match(Reading& now, double elapsed_s);
  PathMatch join(const MatchQuery& query);
  void check_passed(double until_s);
  void place_tool(Reading& now, const PathMatch& point);
  void show(const Reading& now, const PathMatch& point);
  void watch(const Reading& now, const PathMatch& point, double elapsed_s);
  bool way_is_seen(const Reading& now, const PathMatch& point, bool lost);
  void cut_way(const Reading& now, const PathMatch& point);
  void cut_chord(const Reading& now, const PathMatch& point, const SpindleNow& spindle);
  void punch_way(const Reading& now, const PathMatch& point, bool seen);
  SpindleNow spindle_now() const;
  bool is_idle() const;

  StockModel& stock_;
  LiveCutOptions options_;
  LiveFacts facts_;
  ToolState place_;
  PathMatcher matcher_;
  WayCutter cutter_;
  SpindleMemory spindle_;
  SourceWatch source_watch_;
  MachineWatch machine_watch_;
  PathWatch path_watch_;
  LoadWatch loads_;
  LookAhead look_ahead_;
  std::optional<PunchFollower> punch_;  ///< of a sheet that is punched
  LateJoin late_join_;

  AxisSample sample_;  ///< the last one
  double t_s_ = 0;
  std::optional<Reading> before_;
  bool was_on_path_ = false;
  bool runs_ = true;
  bool doubtful_ = false;
  bool restarted_ = false;  ///< the controller has begun again since before_
  bool lost_wild_ = false;  ///< samples were lost before one that was dropped
  std::uint32_t first_line_ = 0;
};

}  // namespace kerf
