#include "twin/machine/timeline.h"

#include <algorithm>

#include "base/block_copy.h"
#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"

namespace kerf {
namespace {

constexpr std::size_t kFirstRing = 64;

bool is_feeding(const Motion& m) { return is_feed(m) || m.kind == MotionKind::kProbe; }

}  // namespace

Timeline::Timeline(const TimelineOptions& options, StepSink& sink)
    : sink_(sink), planner_(options.limits, options.planner, *this), waiting_(kFirstRing) {
  if (options.holds) holds_ = options.holds();
}

Timeline::Waiting& Timeline::wait(const Motion& motion) {
  if (count_ == waiting_.size()) {
    std::rotate(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(first_),
                waiting_.end());
    first_ = 0;
    waiting_.resize(2 * waiting_.size());
  }
  Waiting& waiting = waiting_[(first_ + count_++) & (waiting_.size() - 1)];
  copy_block(waiting.motion, motion);
  if (holds_) waiting.before = waiting.held = {};
  waiting.open = false;
  return waiting;
}

void Timeline::push(const Motion& motion) {
  Waiting& waiting = wait(motion);
  if (holds_) {
    push_held(waiting);
  } else {
    planner_.push(motion);
  }
}

/// What is held before a motion lies between two steps, and what is held behind one that moves,
/// too: a window shows the tip where it stands. A motion that does not move lasts as long as it is
/// held.
void Timeline::push_held(Waiting& waiting) {
  const MotionHold hold = holds_->of(waiting.motion);
  waiting.before = hold.before;
  if (const double before_s = hold.before.sum_s(); before_s > 0) planner_.hold(before_s);
  if (!hold.row.empty()) {
    push_row(waiting, hold.row);
    return;
  }
  waiting.held = hold.after;
  const double after_s = hold.after.sum_s();
  waiting.open = after_s > 0 && !hold.moves;
  const bool open = waiting.open;
  planner_.push(waiting.motion);
  if (after_s <= 0) return;
  planner_.hold(after_s);
  if (open) close(open_timing_->start_s);
}

/// From stand to stand, with a stroke at each.
void Timeline::push_row(Waiting& waiting, std::span<const double> row) {
  planner_.hold(0);
  waiting.open = true;
  const double begin_s = planner_.clock_s(), length_mm = path_length_mm(waiting.motion);
  double at = 0;
  for (const double share : row) {
    const double from_s = planner_.clock_s();
    if (share > at) {
      planner_.push(part_of(waiting.motion, at, share));
      planner_.hold(0);
    }
    const double stroke_s = holds_->stroke_s((share - at) * length_mm, planner_.clock_s() - from_s);
    planner_.hold(stroke_s);
    waiting.held.strokes_s += stroke_s;
    at = share;
  }
  close(begin_s);
}

/// The machine stands, and so the open motion is the only one that waits.
void Timeline::close(double start_s) {
  MotionTiming timing = open_timing_.value_or(MotionTiming{});
  timing.start_s = start_s;
  timing.duration_s = planner_.clock_s() - start_s;
  timing.way = {};
  open_timing_.reset();
  emit(timing);
}

void Timeline::finish() {
  planner_.finish();
  if (!holds_ || totals_from_s_ < 0) return;
  clock_s_ = std::max(clock_s_, planner_.clock_s());
  totals_.duration_s = clock_s_ - totals_from_s_;
}

void Timeline::timed(const MotionTiming& timing) {
  if (!waiting_[first_].open) {
    emit(timing);
  } else if (!open_timing_) {
    open_timing_ = timing;
  }
}

void Timeline::emit(const MotionTiming& timing) {
  const Waiting& waiting = waiting_[first_];
  const Motion& motion = waiting.motion;
  TimedStep step;
  step.start_s = timing.start_s;
  step.duration_s = timing.duration_s;
  if (holds_) step.held_before_s = waiting.before.sum_s();
  step.programmed_mm_per_min = timing.programmed_mm_per_min;
  step.allowed_mm_per_min = timing.allowed_mm_per_min;
  step.peak_mm_per_min = timing.peak_mm_per_min;
  step.way = timing.way;
  const bool moves = motion.kind == MotionKind::kTraverse || is_feeding(motion);
  // Without a known start there is no true length: the real one is not in the program.
  if (moves && motion.start_known) step.length_mm = fed_length_mm(motion);
  clock_s_ = timing.start_s + timing.duration_s;
  sink_.step(motion, step, path_);
  if (moves) count(motion, step);
  if (holds_) {
    if (!totals_.held) totals_.held.emplace();
    *totals_.held += waiting.held;
    if (totals_from_s_ >= 0) *totals_.held += waiting.before;
  }
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
