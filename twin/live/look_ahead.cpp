#include "twin/live/look_ahead.h"

namespace kerf {

LookAhead::LookAhead(const ToolSources& tools, const LiveCutOptions& options)
    : tools_(tools), options_(options) {}

void LookAhead::begin() {
  stale_ = true;
  if (!(options_.guard_s > 0)) return;
  guard_ = std::make_unique<LookAheadGuard>(
      tools_, LookAheadGuard::Options{options_.timeline, options_.guard_s, options_.process,
                                      options_.checks, !options_.wait_for_program});
}

void LookAhead::look(const StockModel& stock, WayCutter& cutter, const PathMatcher& matcher,
                     int tool, double t_s) {
  const PathFollower& follower = matcher.follower();
  if (!on_ || !guard_ || !follower.found() || follower.passed_all()) return;
  if (std::exchange(stale_, false)) guard_->restart(stock, cutter.stage(), matcher.work());
  if (options_.process->traits().is_beam) guard_->set_materials(cutter.update_materials());
  const std::size_t before = warnings_.size();
  RealTip tip = matcher.real_tip();
  tip.program_tool = matcher.program_tool();
  tip.tool = tool;
  guard_->look(*matcher.program(), follower.program_s(), tip, warnings_);
  for (std::size_t i = before; i < warnings_.size(); ++i) warnings_[i].t_s = t_s;
}

}  // namespace kerf
