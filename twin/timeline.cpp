#include "twin/timeline.h"

#include <algorithm>

#include "twin/motion_geometry.h"

namespace kerf {
namespace {

constexpr std::size_t kFirstRing = 1024;

bool is_feeding(const Motion& m) { return is_feed(m) || m.kind == MotionKind::kProbe; }

}  // namespace

Timeline::Timeline(const TimelineOptions& options, StepSink& sink)
    : sink_(sink), planner_(options.limits, options.planner, *this), waiting_(kFirstRing) {}

void Timeline::push(const Motion& motion) {
  if (count_ == waiting_.size()) {
    std::rotate(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(first_),
                waiting_.end());
    first_ = 0;
    waiting_.resize(2 * waiting_.size());
  }
  waiting_[(first_ + count_++) & (waiting_.size() - 1)] = motion;
  planner_.push(motion);
}

void Timeline::timed(const MotionTiming& timing) {
  const Motion& motion = waiting_[first_];
  TimedStep step;
  step.start_s = timing.start_s;
  step.duration_s = timing.duration_s;
  step.programmed_mm_per_min = timing.programmed_mm_per_min;
  step.allowed_mm_per_min = timing.allowed_mm_per_min;
  const bool moves = motion.kind == MotionKind::kTraverse || is_feeding(motion);
  // Without a known start there is no true length: the real one is not in the program.
  if (moves && motion.start_known) step.length_mm = path_length_mm(motion);
  clock_s_ = timing.start_s + timing.duration_s;
  sink_.step(motion, step, path_);
  if (moves) count(motion, step);
  // With the pauses in between, in which no motion runs.
  if (totals_from_s_ < 0) totals_from_s_ = timing.start_s;
  totals_.duration_s = clock_s_ - totals_from_s_;
  path_.clear();
  first_ = (first_ + 1) & (waiting_.size() - 1);
  --count_;
}

void Timeline::count(const Motion& m, const TimedStep& step) {
  const bool traverse = m.kind == MotionKind::kTraverse;
  ++totals_.moves;
  ++(traverse ? totals_.traverse_moves : totals_.feed_moves);
  if (m.kind == MotionKind::kArc) ++totals_.arcs;
  (traverse ? totals_.traverse_mm : totals_.feed_mm) += step.length_mm;
  const bool goes = m.start_known && (step.length_mm > 0 || m.from_abc_deg != m.to_abc_deg);
  if (!traverse && goes && step.programmed_mm_per_min <= 0) ++totals_.moves_without_feed;
}

}  // namespace kerf
