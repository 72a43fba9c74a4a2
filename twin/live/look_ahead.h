// twin/live/look_ahead.h - when a watched machine's program is looked at ahead of it, and from
// which workpiece.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "stock/stock_model.h"
#include "twin/job/tools.h"
#include "twin/live/live_cut_options.h"
#include "twin/live/look_ahead_guard.h"
#include "twin/live/path_matcher.h"
#include "twin/live/way_cutter.h"

namespace kerf {

/// A LookAheadGuard for the program of the machine, begun anew from the workpiece as it is when
/// that is no longer what the program makes of it. The guard has a thread of its own beside a
/// machine, and none of a log.
class LookAhead {
 public:
  LookAhead(const ToolSources& tools, const LiveCutOptions& options);

  /// A program is followed from now on, instead of the one before.
  void begin();
  /// There is none to look at any more.
  void end() { guard_.reset(); }
  /// The copy that it looks at is not what the machine has left.
  void outdate() { stale_ = true; }
  /// Off: nothing is told ahead, at no cost.
  void set_on(bool on) { on_ = on; }
  /// Looks as far as asked for, of a machine that runs its program. `cutter` has been completed;
  /// `tool`: that the machine has in the spindle. Costs the owner a copy of the motions to come,
  /// and after outdate() a snapshot of the workpiece.
  void look(const StockModel& stock, WayCutter& cutter, const PathMatcher& matcher, int tool,
            double t_s);
  /// What has been found since the last call.
  std::vector<AheadWarning> take_warnings() { return std::exchange(warnings_, {}); }

 private:
  const ToolSources& tools_;
  const LiveCutOptions& options_;
  std::unique_ptr<LookAheadGuard> guard_;
  bool stale_ = true;
  bool on_ = true;
  std::vector<AheadWarning> warnings_;
};

}  // namespace kerf
