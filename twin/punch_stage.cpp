#include "twin/punch_stage.h"

#include <algorithm>
#include <utility>

#include "twin/motion_geometry.h"
#include "twin/stock_choice.h"

namespace kerf {

PunchStage::PunchStage(StockModel& stock, FindingLog& log, TurretPointer turret)
    : stock_(stock),
      turret_(std::move(turret)),
      moves_(turret_),
      checks_(*as_sheet(stock), log, turret_) {}

void PunchStage::take(const Motion& m, const TimedStep& step) {
  recent_[taken_ % recent_.size()] = m;
  hits_.clear();
  moves_.hits(
      taken_++, [this](std::size_t n) -> const Motion& { return recent_[n % recent_.size()]; },
      hits_);
  has_moved_ = has_moved_ || is_feed(m) || m.kind == MotionKind::kTraverse;
  checks_.follow(m, step, moves_.drags(m));
  if (!hits_.empty()) strike(m, step);
}

void PunchStage::strike(const Motion& m, const TimedStep& step) {
  has_struck_ = true;
  const TurretStation* const station = turret_->station(m.tool);
  if (station == nullptr) {
    checks_.no_station(m, step, hits_.front().place_mm);
    return;
  }
  strokes_.clear();
  for (const PunchHit& hit : hits_) strokes_.push_back(PunchMoves::stroke_of(hit, 0));
  ToolUse& use = use_of(*station);
  const bool nibbled = moves_.nibbles(m);
  if (nibbled) {
    totals_.nibbled_mm += step.length_mm;
    use.feed_mm += step.length_mm;
  }
  totals_.hits += hits_.size();
  totals_.stations[static_cast<std::size_t>(&use - uses_.data())].hits += hits_.size();
  checks_.strikes(m, step, station->punch, strokes_);
  reports_.clear();
  stock_.cut(station->punch, strokes_, reports_);
  stock_.finish(reports_);
  double removed_mm3 = 0;
  for (const CutReport& report : reports_) {
    removed_mm3 += report.removed_mm3;
    use.max_depth_mm = std::max(use.max_depth_mm, report.depth_mm);
  }
  use.removed_mm3 += removed_mm3;
  add_cutting(use, step.duration_s, removed_mm3);
  checks_.struck(m, step, station->punch, strokes_, removed_mm3, nibbled);
}

ToolUse& PunchStage::use_of(const TurretStation& station) {
  for (ToolUse& use : uses_) {
    if (use.number == station.number) return use;
  }
  ToolUse& use = uses_.emplace_back();
  use.number = station.number;
  use.shape = station.punch.spec();
  use.origin = "turret";
  totals_.stations.push_back({station.number, station.name, station.shape, 0});
  return use;
}

PunchTotals PunchStage::totals() const {
  PunchTotals totals = totals_;
  totals.regrips = checks_.regrips() - regrips_before_;
  return totals;
}

void PunchStage::begin_reporting() {
  totals_ = {};
  uses_.clear();
  regrips_before_ = checks_.regrips();
  checks_.forget_events();
}

void PunchStage::finish(bool whole) {
  if (whole && has_moved_ && !has_struck_) checks_.never_struck();
  for (ToolUse& use : uses_) {
    if (use.peak_mm3_per_s == 0) close_window(use);
  }
}

}  // namespace kerf
