#include "twin/process/punch/punch_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/translate.h"
#include "twin/findings/finding_json.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {

PunchStage::PunchStage(ProcessSite& site, TurretPointer turret)
    : site_(site),
      feeds_(site.feeds),
      stock_(site.stock),
      turret_(std::move(turret)),
      moves_(turret_),
      checks_(*site.stock.sheet(), site.log, turret_) {}

void PunchStage::go_on_from(const Process& process) {
  const auto& other = static_cast<const PunchStage&>(process);
  checks_.go_on_from(other.checks_);
  recent_ = other.recent_;
  taken_ = other.taken_;
  has_struck_ = other.has_struck_;
  has_moved_ = other.has_moved_;
}

void PunchStage::begin(const Motion& m, const TimedStep& step) {
  recent_[taken_ % recent_.size()] = m;
  hits_.clear();
  strokes_.clear();
  struck_ = 0;
  removed_mm3_ = 0;
  moves_.hits(
      taken_++, [this](std::size_t n) -> const Motion& { return recent_[n % recent_.size()]; },
      hits_);
  if (moves_.strikes_unseen(m)) checks_.strikes_unseen(m, step);
  has_moved_ = has_moved_ || is_feed(m) || m.kind == MotionKind::kTraverse;
  checks_.follow(m, step, moves_.drags(m));
}

void PunchStage::take(const Motion& m, const TimedStep& step, std::span<const PathPiece> /*path*/) {
  if (is_feed(m) && m.start_known) feeds_.note(m, step);
  take_part(m, step, 1, true);
}

void PunchStage::take_part(const Motion& m, const TimedStep& step, double share, bool seen) {
  if (!is_open_) begin(m, step);
  is_open_ = share < 1;
  std::size_t until = struck_;
  while (until < hits_.size() && hits_[until].share <= share) ++until;
  const std::span<const PunchHit> fresh(hits_.data() + struck_, until - struck_);
  struck_ = until;
  if (seen && !fresh.empty()) strike(m, step, fresh);
  if (!is_open_) end(m, step);
}

void PunchStage::end_open() {
  if (is_open_) end(recent_[(taken_ - 1) % recent_.size()], {});
}

void PunchStage::take_seen(const Motion& m, const TimedStep& step, std::span<const PunchHit> hits) {
  end_open();
  strokes_.clear();
  removed_mm3_ = 0;
  checks_.follow(m, step, false);
  strike(m, step, hits);
  end(m, step);
}

void PunchStage::note_dragging(const Motion& m, const TimedStep& step) {
  checks_.follow(m, step, true);
}

void PunchStage::strike(const Motion& m, const TimedStep& step, std::span<const PunchHit> hits) {
  has_struck_ = true;
  const TurretStation* const station = turret_->station(m.tool);
  if (station == nullptr) {
    checks_.no_station(m, step, hits.front().place_mm);
    return;
  }
  const std::size_t before = strokes_.size();
  for (const PunchHit& hit : hits) strokes_.push_back(PunchMoves::stroke_of(hit, 0));
  const std::span<const CutMove> fresh = std::span<const CutMove>(strokes_).subspan(before);
  ToolUse& use = use_of(*station);
  totals_.hits += hits.size();
  totals_.stations[static_cast<std::size_t>(&use - uses_.data())].hits += hits.size();
  checks_.strikes(m, step, station->punch, fresh);
  reports_.clear();
  stock_.cut(station->punch, fresh, reports_);
  stock_.finish(reports_);
  for (const CutReport& report : reports_) {
    site_.note_cut(site_.motion, report.removed_mm3, report.depth_mm);
    removed_mm3_ += report.removed_mm3;
    use.removed_mm3 += report.removed_mm3;
    use.max_depth_mm = std::max(use.max_depth_mm, report.depth_mm);
  }
  checks_.note_freed(m, step);
}

/// What is to be said of a motion's strokes together.
void PunchStage::end(const Motion& m, const TimedStep& step) {
  is_open_ = false;
  const TurretStation* const station = turret_->station(m.tool);
  if (strokes_.empty() || station == nullptr) return;
  const bool nibbled = moves_.nibbles(m);
  ToolUse& use = use_of(*station);
  if (nibbled) {
    totals_.nibbled_mm += step.length_mm;
    use.feed_mm += step.length_mm;
  }
  add_cutting(use, punching_s(m, step), removed_mm3_);
  checks_.struck(m, step, station->punch, strokes_, removed_mm3_, nibbled);
}

/// Without a time for strokes the steps' own are all there is.
double PunchStage::punching_s(const Motion& m, const TimedStep& step) const {
  if (turret_->times.stroke_s <= 0 || moves_.nibbles(m)) return step.duration_s;
  return turret_->times.stroke_s * static_cast<double>(strokes_.size());
}

ToolUse& PunchStage::use_of(const TurretStation& station) {
  for (ToolUse& use : uses_) {
    if (use.number == station.number) return use;
  }
  ToolUse& use = uses_.emplace_back();
  use.number = station.number;
  use.shape = station.punch.spec();
  use.origin = tr("turret");
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
  end_open();
  if (whole && has_moved_ && !has_struck_) checks_.never_struck();
  for (ToolUse& use : uses_) {
    if (use.peak_mm3_per_s == 0) close_window(use);
  }
}

std::shared_ptr<const ProcessSums> PunchStage::sums() const {
  return std::make_shared<PunchSums>(totals());
}

void PunchSums::add_json(nlohmann::ordered_json& out) const {
  nlohmann::ordered_json punch;
  punch["hits"] = totals.hits;
  punch["nibbled_mm"] = rounded(totals.nibbled_mm);
  punch["regrips"] = totals.regrips;
  nlohmann::ordered_json stations = nlohmann::ordered_json::array();
  for (const StationUse& use : totals.stations) {
    stations.push_back(
        {{"station", use.station}, {"name", use.name}, {"shape", use.shape}, {"hits", use.hits}});
  }
  punch["stations"] = std::move(stations);
  out["punch"] = std::move(punch);
}

std::string PunchSums::text() const {
  std::string out = trf("sheet     {}", trnf("{} hit", "{} hits", totals.hits));
  if (totals.nibbled_mm > 0) out += trf(", {:.1f} mm nibbled", totals.nibbled_mm);
  if (totals.regrips > 0)
    out += fmt::format(", {}", trnf("{} re-grip", "{} re-grips", totals.regrips));
  out += '\n';
  for (const StationUse& use : totals.stations) {
    out += trf("          station {:<3} {}, {}{}\n", use.station, use.shape,
               trnf("{} hit", "{} hits", use.hits),
               use.name.empty() ? "" : fmt::format(" ({})", use.name));
  }
  return out;
}

std::string PunchSums::run_text() const { return trnf("{} hit", "{} hits", totals.hits); }

}  // namespace kerf
