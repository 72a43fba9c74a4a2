#include "interp_bridge/timing/lookahead.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/block_copy.h"
#include "interp_bridge/timing/corner.h"

namespace kerf {
namespace {

/// Servo periods from the end of the braking to the start of the next segment: the planner comes to
/// rest in one and looks at the queue in the next. Measured: none after a G61.1 stop, nor where the
/// next segment has begun meanwhile.
double stop_periods(SegmentEnd end, bool last) {
  return end == SegmentEnd::kExact || (end == SegmentEnd::kParabolic && last) ? 1.0 : 0.0;
}

std::size_t capacity_for(int depth) { return std::bit_ceil(static_cast<std::size_t>(depth) + 8); }

}  // namespace

Lookahead::Lookahead(const AxisRates& rates, Schedule& schedule)
    : rates_(rates),
      schedule_(schedule),
      queue_(capacity_for(rates.depth)),
      limits_(capacity_for(rates.depth)) {}

void Lookahead::add(Segment& segment) {
  clamp_to_cycle(segment, rates_.cycle_s);
  if (!queue_.empty()) {
    Segment& previous = queue_.back().segment;
    Segment& blend = blend_;
    switch (join_corner(rates_, previous, segment, blend)) {
      case CornerKind::kPlain:
        finalize_back(true);
        break;
      case CornerKind::kBlend:
        finalize_back(true);
        copy_block(queue_.push().segment, blend);
        finalize_back(true);
        break;
      case CornerKind::kSwallowed:
        blend.first_piece = previous.first_piece;
        blend.piece_count = previous.piece_count;
        copy_block(previous, blend);
        finalize_back(true);
        break;
    }
  }
  copy_block(queue_.push().segment, segment);
  const std::uint64_t depth = static_cast<std::uint64_t>(rates_.depth);
  while (queue_.size() > depth + 1) {
    // The youngest may still be shortened to half by its own corner, and must stop there.
    const double horizon = queue_[queue_.end() - 2].sum + segment.accel() * segment.length_mm;
    retire(horizon);
  }
}

/// With nothing after the last segment.
void Lookahead::finish_back() {
  finalize_back(false);
  limit_corner(queue_.end() - 1, 0);
}

void Lookahead::drain() {
  if (!queue_.empty()) {
    finish_back();
    const double end = queue_.back().sum;
    while (!queue_.empty()) retire(end);
  }
  limits_.clear();
  retired_sum_ = 0;
  speed_ = 0;
  schedule_.settle();
}

void Lookahead::limit_corner(std::uint64_t number, double square) {
  const double height = square + queue_[number].sum;
  while (!limits_.empty() && limits_.back().height >= height) limits_.pop_back();
  limits_.push() = {number, height};
}

/// The last segment's length is settled: so are its speed and the corner before it. With nothing
/// after it LinuxCNC never settles it: an arc keeps the cautious share of its acceleration that it
/// was queued with, and it is entered no faster than as if the next corner cut half of it away.
void Lookahead::finalize_back(bool followed) {
  const std::uint64_t number = queue_.end() - 1;
  Queued& queued = queue_[number];
  Segment& segment = queued.segment;
  if (followed) {
    finalize(segment, rates_.cycle_s);
  } else {
    clamp_to_cycle(segment, rates_.cycle_s);
  }
  const bool first = number == queue_.begin();
  const double before = first ? retired_sum_ : queue_[number - 1].sum;
  queued.sum = before + 2.0 * segment.accel() * segment.length_mm;
  if (first) return;
  const Segment& previous = queue_[number - 1].segment;
  double speed = 0;
  if (previous.end == SegmentEnd::kTangent) {
    speed = std::min(previous.max_speed, segment.max_speed);
    if (previous.corner_speed >= 0) speed = std::min(speed, previous.corner_speed);
  }
  double square = speed * speed;
  if (!followed) square = std::min(square, segment.accel() * segment.length_mm);
  limit_corner(number - 1, square);
}

/// How fast `next` may be entered, which `segment` runs into at `target`. Of one that follows the
/// spindle LinuxCNC learns its speed from the segment before, if that follows the spindle too; from
/// one that does not it brakes to a standstill, as far as it gets within that one.
double Lookahead::speed_into(const Segment& segment, const Segment& next, double target) const {
  if (!next.follows_spindle()) return next.target(rates_);
  if (!segment.follows_spindle()) return 0;
  Segment entered = next;
  entered.spindle_speed = target;
  return entered.target(rates_);
}

/// How the oldest segment is run, from clock_s on. horizon: S where the known path ends with a
/// stop.
Lookahead::Run Lookahead::run_of_front(double horizon, double clock_s) {
  const std::uint64_t number = queue_.begin();
  const Queued& queued = queue_.front();
  const Segment& segment = queued.segment;
  while (!limits_.empty() && limits_.front().number < number) limits_.pop_front();
  double height = horizon;
  if (!limits_.empty()) height = std::min(height, limits_.front().height);
  const double target = segment.target(rates_);
  const Segment* const next = queue_.size() > 1 ? &queue_[number + 1].segment : nullptr;
  double final_speed = 0;
  if (next != nullptr && segment.end == SegmentEnd::kTangent) {
    final_speed = std::sqrt(std::max(height - queued.sum, 0.0));
    final_speed = std::min({final_speed, target, speed_into(segment, *next, target)});
  }
  Run run;
  run.profile =
      next != nullptr && segment.next_comes_s > clock_s
          ? surprised_profile(segment.length_mm, segment.accel_alone, segment.accel(), speed_,
                              target, final_speed, segment.next_comes_s - clock_s)
          : speed_profile(segment.length_mm, segment.accel(), speed_, target, final_speed);
  if (next == nullptr || segment.end != SegmentEnd::kTangent) {
    run.profile.end_speed = 0;
    run.profile.rest_s = stop_periods(segment.end, next == nullptr) * rates_.cycle_s;
    run.profile.duration_s += run.profile.rest_s;
    if (next != nullptr && segment.end == SegmentEnd::kParabolic) {
      const double into = speed_into(segment, *next, target);
      if (into > 0) {
        const ParabolicSpeeds speeds = parabolic_speeds(segment, *next, target, into);
        const double leaving = std::min(speeds.leaving, run.profile.peak_speed);
        run.overlap = {leaving / segment.accel(), segment.accel(), next->accel(), into, next};
      }
    }
  }
  return run;
}

void Lookahead::drop_front(const Run& run) {
  speed_ = run.profile.end_speed;
  retired_sum_ = queue_.front().sum;
  queue_.pop_front();
}

void Lookahead::retire(double horizon) {
  const Run run = run_of_front(horizon, schedule_.clock_s());
  schedule_.run(queue_.front().segment, run.profile, run.overlap);
  drop_front(run);
}

/// Runs a copy of the queue to its end.
Lookahead::Rest Lookahead::rest() const {
  Lookahead copy = *this;
  Rest rest;
  rest.end_s = schedule_.clock_s();
  if (copy.queue_.empty()) return rest;
  copy.finish_back();
  const double horizon = copy.queue_.back().sum;
  while (!copy.queue_.empty()) {
    rest.last_begins_s = rest.end_s;
    rest.last_speed = copy.speed_;
    const Run run = copy.run_of_front(horizon, rest.end_s);
    rest.end_s += std::max(run.profile.duration_s - run.overlap.seconds, 0.0);
    copy.drop_front(run);
  }
  return rest;
}

double Lookahead::end_s() const { return rest().end_s; }

void Lookahead::next_comes_at(double clock_s) {
  if (queue_.empty()) return;
  const Rest alone = rest();
  Segment& last = queue_.back().segment;
  last.next_comes_s = clock_s;
  last.accel_alone = last.accel();
  if (clock_s <= alone.last_begins_s) return;
  const SpeedPoint then = point_before_stop(last.length_mm, last.accel_alone, alone.last_speed,
                                            last.target(rates_), clock_s - alone.last_begins_s);
  last.half_run = then.way_mm > last.length_mm / 2;
}

}  // namespace kerf
