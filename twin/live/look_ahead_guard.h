// twin/live/look_ahead_guard.h - what the next seconds of the program would do to the workpiece as
// it is.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/job/tools.h"
#include "twin/live/program_ahead.h"
#include "twin/live/real_tip.h"
#include "twin/process/cut_stage.h"

namespace kerf {

/// A finding that has not happened yet.
struct AheadWarning {
  Finding finding;  ///< its time_s is that of the program
  double in_s = 0;  ///< from t_s, by the plan; 0 if it is overdue
  double t_s = 0;   ///< when it was told, since the first sample
};

/// Runs the program ahead of the machine, on a copy of the workpiece that the machine has really
/// left, with the tool that it really has in the spindle, at the tip where its length puts it.
/// While the machine keeps to the program the copy only needs what comes next; when it has done
/// something else, the owner calls restart().
///
/// Cuts in a thread of its own, motion by motion, so that what is dear ahead of the machine (the
/// first contact of a helix: seconds) costs the owner nothing but copies of motions; or, for logs,
/// in the owner's, and all of it before look() returns. Nothing is told that is farther ahead than
/// the horizon, however long the motion is that brings it.
class LookAheadGuard {
 public:
  struct Options {
    TimelineOptions timeline;
    double horizon_s = 10;  ///< how far it looks
    ProcessPointer process = default_process();
    CheckOptions checks;
    bool own_thread = true;
  };
  LookAheadGuard(ToolSources tools, Options options);
  /// What is not cut yet is not any more.
  ~LookAheadGuard();
  LookAheadGuard(const LookAheadGuard&) = delete;
  LookAheadGuard& operator=(const LookAheadGuard&) = delete;

  /// Begins anew from the workpiece as it is. `stage`: what has cut it.
  void restart(const StockModel& stock, const CutStage& stage, const WorkpieceFrame& frame);
  /// Of a torch program, all that the motions name so far.
  void set_materials(std::span<const TorchMaterial> materials);

  /// Has the copy brought to `now_s` + horizon of program time, and appends what has been found to
  /// come until then; nothing twice, restarts included. `tip`: of the machine now. Until the
  /// program changes the tool, it is what it is; where it has become another, the owner calls
  /// restart().
  void look(const ProgramAhead& program, double now_s, const RealTip& tip,
            std::vector<AheadWarning>& out);

  double horizon_s() const { return options_.horizon_s; }

 private:
  /// The copy of the workpiece and what cuts it.
  struct Copy {
    std::unique_ptr<StockModel> stock;
    std::unique_ptr<ToolResolver> resolver;
    FindingLog log;
    std::unique_ptr<CutStage> stage;
    std::size_t collected = 0;
  };
  /// What the thread is to do, in this order.
  struct Work {
    std::unique_ptr<Copy> copy;  ///< null: the one it has
    std::vector<TorchMaterial> materials;
    std::vector<PlannedMotion> motions;
    bool whole = false;  ///< the program is at its end
  };
  struct Found {
    Finding finding;
    std::uint64_t copies = 0;
  };
  void run();
  void hand(Work work);
  void cut(Work& work, std::uint64_t copies);
  bool is_overtaken(std::uint64_t copies) const;
  void tell(double now_s, std::vector<AheadWarning>& out);

  ToolSources tools_;
  Options options_;
  // Of the owner.
  std::uint64_t copies_ = 0;  ///< handed
  std::unique_ptr<Copy> fresh_;
  std::vector<TorchMaterial> materials_;
  std::size_t handed_materials_ = 0;
  std::uint64_t next_ = 0;  ///< number of the program's motion that comes next
  double change_s_ = 0;     ///< the last tool change that was handed: program time
  bool begun_ = false;
  bool finished_ = false;
  std::vector<Finding> ahead_;                            ///< found, and not told yet
  std::map<std::pair<int, std::uint64_t>, double> told_;  ///< finding id, file and line: when
  // Of who cuts.
  std::unique_ptr<Copy> copy_;
  // Of both.
  mutable std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::deque<Work> works_;
  std::uint64_t newest_ = 0;  ///< copy that has been handed
  std::vector<Found> found_;
  std::stop_source stop_;
  std::jthread thread_;
};

}  // namespace kerf
