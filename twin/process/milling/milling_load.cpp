// What MillingStage asks of the load of its feed moves: how long they cut, and how fast.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "twin/job/blank_choice.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/milling/milling_stage.h"
#include "twin/process/milling/way_profile.h"

namespace kerf {
namespace {

/// Short moves are looked at on their own where they are at least so much of a window long and
/// there is enough to spend.
constexpr double kLeastOfWindow = 0.5;

/// Round a corner the planner goes as fast as the faster of its two moves.
double reached_mm_per_min(const TimedStep& step) {
  // Of a program that is played only the F word is kept.
  if (step.peak_mm_per_min <= 0) return step.programmed_mm_per_min;
  return step.programmed_mm_per_min > 0 ? std::min(step.peak_mm_per_min, step.programmed_mm_per_min)
                                        : step.peak_mm_per_min;
}

}  // namespace

/// What a feed move counts for: where the blank never was it does not cut. Of one that lasts: how
/// long it really cuts, and how fast at most. Short ones are taken together (add_short_move). Of a
/// program that is played nobody asks.
void MillingStage::measure(const Motion& m, const TimedStep& step, InFlight& flight) {
  cut_parts_.clear();
  if (site_.timed || site_.holding || !is_feed(m) || divided_.empty() || step.duration_s <= 0)
    return;
  const Cutter& cutter = *mounted_->cutter;
  if (divided_.size() > 1 || !LoadMeter::is_one_piece(divided_[0])) {
    if (!comes_near(m)) return;
    hand_over();
    load_meter_.cut_parts(cutter, divided_, cut_parts_);
    return;
  }
  load_meter_.look(cutter, divided_[0], step.duration_s, step.peak_mm_per_min / 60, flight.reach);
  const bool lasts = step.duration_s >= LoadMeter::kLasting_s;
  if (!lasts && step.length_mm < kLeastOfWindow * load_meter_.window_mm(cutter)) return;
  if ((!lasts && !load_meter_.affords_short()) || !comes_near(m)) return;
  hand_over();
  ToolUse& use = uses_[use_];
  const MotionLoad load = load_meter_.measure(cutter, divided_[0], use.peak_mm3_per_s);
  use.cut_s += load.cut_s;
  use.peak_mm3_per_s = std::max(use.peak_mm3_per_s, load.peak_mm3_per_s);
  flight.measured = true;
}

/// Of a feed move, how the tool is engaged in what stands before it is cut. Where it is cut as
/// several, each of them has its share of the time.
void MillingStage::engage(const Motion& m, const TimedStep& step, InFlight& flight) {
  if (!flight.feed || site_.holding || divided_.empty()) return;
  part_rpm_ = m.spindle == SpindleState::kStopped ? 0 : m.spindle_rpm;
  // A machine that is watched has the feed that it has.
  part_mm_per_min_ = site_.watched ? step.programmed_mm_per_min : reached_mm_per_min(step);
  const std::size_t heard_before = engaged_parts_.heard();
  const bool near = comes_near(m);
  const bool one_piece = divided_.size() == 1 && LoadMeter::is_one_piece(divided_[0]);
  if (!one_piece && !stock_.takes_tilted_tools()) {
    if (near) engagement_->take_unmeasured(step.length_mm);
    if (near) loads_.tell_unmeasured(step.start_s, step.duration_s, site_.loads);
    engagement_->lift();
    return;
  }
  double ways = 0;
  for (const CutMove& move : divided_) ways += way_length_mm(move);
  if (ways <= 0) return;
  EngagementSums sums;
  double most_mm3 = 0, start_s = step.start_s;
  for (const CutMove& move : divided_) {
    const double duration_s = step.duration_s * way_length_mm(move) / ways;
    std::optional<CutMove> circle;
    if (move.arc) circle = as_circle(move);
    const CutMove& looked_at = circle ? *circle : move;
    const EngagementMeter::Taken& taken =
        engagement_->take({cutting(), looked_at, near, m.spindle == SpindleState::kCounterclockwise,
                           m.source, start_s, duration_s});
    start_s += duration_s;
    if (taken.pass != EngagementLog::kNoPass) flight.pass = taken.pass;
    sums.add(taken.sums);
    most_mm3 += taken.most_mm3;
    engagement_->note(move);
  }
  const auto count = static_cast<double>(divided_.size());
  flight.engaged_mm = sums.in_material_mm() / count;
  flight.engaged_s = sums.cut_s / count;
  flight.engaged_mm3 = most_mm3 / count;
  // Those before may have been taken meanwhile.
  flight.parts = engaged_parts_.heard() - heard_before;
  flight.way_mm = step.length_mm;
  flight.bounds_parts = divided_.size() == 1;
}

void MillingStage::judge_parts(const InFlight& move, const CutReport& report) {
  if (!engagement_) return;
  if (!move.feed) engaged_parts_.end_way();
  EngagedParts::Done done;
  done.parts = move.parts;
  done.is_whole = move.bounds_parts;
  done.may_wait = !site_.watched;
  done.pass = move.pass;
  done.motion = move.motion;
  done.removed_mm3 = report.removed_mm3, done.depth_mm = report.depth_mm;
  done.front_mm = engaged_parts_.is_waiting() ? front_mm_of(move.way_mm, report) : 0;
  done.reach_mm = cutter() != nullptr ? cutter()->radius_mm() : 0;
  done.cell_mm = stock_.cell_mm();
  engaged_parts_.judge(done);
}

/// How far before its middle the cutter meets material of that depth, and of the width that this
/// removal has. Octrees tell what the front takes with the move that takes it.
double MillingStage::front_mm_of(double way_mm, const CutReport& report) const {
  if (stock_.takes_tilted_tools() || cutter() == nullptr || report.depth_mm <= 0) return 0;
  const double half_mm = half_width_mm(*cutter(), report.depth_mm);
  const double least_mm = std::max(way_mm, stock_.cell_mm());
  const double width_mm = report.removed_mm3 / (report.depth_mm * least_mm);
  const double beside_mm = std::max(0.0, half_mm - width_mm);
  return std::sqrt(std::max(0.0, half_mm * half_mm - beside_mm * beside_mm));
}

void MillingStage::count_feed(ToolUse& use, const InFlight& move, const CutReport& report) const {
  if (site_.watched) {
    use.grain_s += move.duration_s;
    use.grain_mm3 += report.removed_mm3;
    if (use.grain_s < kGrain_s) return;
    const double duration_s = std::exchange(use.grain_s, 0);
    add_cutting(use, duration_s, std::exchange(use.grain_mm3, 0));
    return;
  }
  const MotionReach& reach = move.reach;
  const double bound = report.depth_mm > 0
                           ? report.depth_mm * reach.side_mm2_per_s + reach.disc_mm3_per_s
                           : std::numeric_limits<double>::infinity();
  if (reach.part.known) {
    const bool begins = report.removed_mm3 > 0 && use.gap_mm > reach.part.near_mm &&
                        use.gap_mm < std::numeric_limits<double>::infinity();
    const double front_mm = begins ? front_mm_of(reach.part.way_mm, report) : 0;
    add_short_move(use, reach.part, report.removed_mm3, bound, front_mm);
  } else {
    use.gap_mm = std::numeric_limits<double>::infinity();
    add_cutting(use, move.cut_part * move.duration_s, report.removed_mm3, bound);
  }
  const double mean = report.removed_mm3 * reach.speed_per_mm;
  use.peak_mm3_per_s = std::max(use.peak_mm3_per_s, std::min(mean, bound));
}

void MillingStage::note_teeth(const Motion& m, const TimedStep& step, InFlight& flight) const {
  const std::optional<int> teeth = cutting().teeth();
  if (!teeth || !flight.feed || m.spindle == SpindleState::kStopped || m.spindle_rpm <= 0) return;
  flight.rpm = m.spindle_rpm;
  const double teeth_per_min = m.spindle_rpm * *teeth;
  const double most = reached_mm_per_min(step);
  flight.feed_per_tooth_mm = most / teeth_per_min;
  const double mean = step.duration_s > 0 ? 60 * step.length_mm / step.duration_s : most;
  flight.mean_per_tooth_mm = std::min(mean, most) / teeth_per_min;
}

void MillingStage::count_chip(ChipLoad& chip, const InFlight& move, const CutReport& report) const {
  chip.add(move.feed_per_tooth_mm, move.mean_per_tooth_mm, move.cut_part * move.duration_s,
           move.source);
  const double wide_mm = 2 * half_width_mm(cutting(), report.depth_mm);
  chip.speed_m_per_min = std::max(chip.speed_m_per_min, kPi * wide_mm * move.rpm / 1000);
}

}  // namespace kerf
