#include "interp_bridge/timing/lookahead.h"

#include <algorithm>
#include <bit>
#include <cmath>

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

void Lookahead::add(Segment segment) {
  clamp_to_cycle(segment, rates_.cycle_s);
  if (!queue_.empty()) {
    Segment& previous = queue_.back().segment;
    Segment blend;
    switch (join_corner(rates_, previous, segment, blend)) {
      case CornerKind::kPlain:
        finalize_back(true);
        break;
      case CornerKind::kBlend:
        finalize_back(true);
        queue_.push().segment = blend;
        finalize_back(true);
        break;
      case CornerKind::kSwallowed:
        blend.first_piece = previous.first_piece;
        blend.piece_count = previous.piece_count;
        previous = blend;
        finalize_back(true);
        break;
    }
  }
  queue_.push().segment = segment;
  const std::uint64_t depth = static_cast<std::uint64_t>(rates_.depth);
  while (queue_.size() > depth + 1) {
    // The youngest may still be shortened to half by its own corner, and must stop there.
    const double horizon = queue_[queue_.end() - 2].sum + segment.accel() * segment.length_mm;
    retire(horizon);
  }
}

void Lookahead::drain() {
  if (!queue_.empty()) {
    finalize_back(false);
    const double end = queue_.back().sum;
    limit_corner(queue_.end() - 1, 0);
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

/// The last segment's length is settled: so are its speed and the corner before it. An arc with
/// nothing after it keeps the cautious share of its acceleration that it was queued with.
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
  limit_corner(number - 1, speed * speed);
}

/// Runs the oldest segment. horizon: S where the known path ends with a stop.
void Lookahead::retire(double horizon) {
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
    final_speed = std::min({final_speed, target, next->target(rates_)});
  }
  SpeedProfile profile =
      speed_profile(segment.length_mm, segment.accel(), speed_, target, final_speed);
  speed_ = profile.end_speed;
  double overlap = 0;
  if (next == nullptr || segment.end != SegmentEnd::kTangent) {
    speed_ = 0;
    profile.duration_s += stop_periods(segment.end, next == nullptr) * rates_.cycle_s;
    if (next != nullptr && segment.end == SegmentEnd::kParabolic) {
      const ParabolicSpeeds speeds = parabolic_speeds(segment, *next, target, next->target(rates_));
      overlap = std::min(speeds.leaving, profile.peak_speed) / segment.accel();
    }
  }
  schedule_.run(segment, profile, overlap);
  retired_sum_ = queued.sum;
  queue_.pop_front();
}

}  // namespace kerf
