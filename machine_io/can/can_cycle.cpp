#include "machine_io/can/can_cycle.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace kerf {

bool CanCycle::ends_before(std::uint16_t axes, std::int64_t at_ns) const {
  if (count_ == 0) return false;
  if ((gathered_ & axes) != 0 || at_ns > first_ns() + gather_ns_) return true;
  if (!is_cyclic() || synced_ >= kLearnt || !is_out_of_order(axes)) return false;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if ((axes >> i & 1U) == 0) continue;
    // From cycles that are closed it may be known to be missing.
    return at_ns - last_of_axis_[i] > (3 + 2 * missed_[i]) * period_ns_ / 2;
  }
  return false;
}

/// Some of what is gathered comes after these axes as a rule.
bool CanCycle::is_out_of_order(std::uint16_t axes) const {
  for (std::size_t i = order_.size(); i-- > 0 && order_[i] != axes;) {
    if ((order_[i] & gathered_) != 0) return true;
  }
  return false;
}

void CanCycle::add(std::uint16_t axes, std::int64_t at_ns) {
  assert(count_ < frames_.size() && (gathered_ & axes) == 0);
  frames_[count_++] = {axes, at_ns};
  gathered_ = static_cast<std::uint16_t>(gathered_ | axes);
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if ((axes >> i & 1U) == 0) continue;
    last_of_axis_[i] = at_ns;
    missed_[i] = 0;
  }
}

bool CanCycle::ends_at_sync() {
  if (count_ == 0) {
    sync_before_ = true;
    return false;
  }
  const bool ends = synced_ >= kLearnt;
  sync_inside_ = !ends;
  return ends;
}

void CanCycle::clear() {
  count_ = 0;
  gathered_ = 0;
  sync_inside_ = false;
}

CanCycle::Verdict CanCycle::close() {
  std::int64_t widest_ns = 0;
  std::size_t after = 0;
  for (std::size_t i = 1; i < count_; ++i) {
    const std::int64_t pause_ns = frames_[i].at_ns - frames_[i - 1].at_ns;
    if (pause_ns <= widest_ns) continue;
    widest_ns = pause_ns;
    after = i;
  }
  const bool again = start_ns_ != 0 && has_pause() && widest_ns >= kLeastPause_ns &&
                     frames_[after].axes == after_widest_ &&
                     4 * std::abs(widest_ns - widest_ns_) <= widest_ns_;
  const bool shifted = again && (first_ns() - before_ns_) * kPauseRatio < widest_ns;
  shifts_ = shifted ? shifts_ + 1 : 0;
  if (shifts_ + 1 >= kShifts) {
    std::copy(frames_.begin() + static_cast<std::ptrdiff_t>(after),
              frames_.begin() + static_cast<std::ptrdiff_t>(count_), frames_.begin());
    count_ -= after;
    gathered_ = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      gathered_ = static_cast<std::uint16_t>(gathered_ | frames_[i].axes);
    }
    sync_inside_ = false;
    run_ = synced_ = shifts_ = 0;
    start_ns_ = 0;
    widest_ns_ = 0;
    return Verdict::kShifted;
  }
  if (may_be_of_two()) {
    late_axes_ = 0;
    for (std::size_t i = after; i < count_; ++i) {
      late_axes_ = static_cast<std::uint16_t>(late_axes_ | frames_[i].axes);
    }
    doubted_ = 1 + (last_ns() - first_ns() - span_ns_ + period_ns_ / 2) / period_ns_;
    ++doubts_;
    before_ns_ = last_ns();
    start_ns_ = 0;
    widest_ns_ = 0;
    sync_before_ = false;
    clear();
    return Verdict::kDoubted;
  }
  doubts_ = 0;
  learn();
  widest_ns_ = widest_ns;
  after_widest_ = widest_ns > 0 ? frames_[after].axes : 0;
  before_ns_ = last_ns();
  start_ns_ = first_ns();
  clear();
  return Verdict::kWhole;
}

/// Of the complete cycle that is gathered: it takes much longer than the others.
bool CanCycle::may_be_of_two() const {
  return is_cyclic() && calm_ >= kCalm && synced_ < kLearnt && doubts_ < kMostIncomplete &&
         4 * (period_ns_ - span_ns_) >= period_ns_ && period_ns_ - span_ns_ >= kLeastPause_ns &&
         last_ns() - first_ns() > span_ns_ + period_ns_ / 2;
}

bool CanCycle::is_doubt_true(std::int64_t next_ns) {
  if (next_ns < doubted_until_ns()) return false;
  missing_ += static_cast<int>(doubted_);
  missing_axes_ = late_axes_;
  return true;
}

/// Of the complete cycle that is gathered.
void CanCycle::learn() {
  if (pending_ > 0) {
    missing_ += pending_;
    missing_axes_ = pending_axes_;
  }
  pending_ = 0;
  pending_axes_ = 0;
  if (sync_inside_) {
    synced_ = 0;
  } else if (sync_before_) {
    synced_ = std::min(synced_ + 1, kLearnt);
  }
  sync_before_ = false;
  std::array<std::uint16_t, kMaxPositions> order{};
  for (std::size_t i = 0; i < count_; ++i) order[i] = frames_[i].axes;
  run_ = order == order_ ? std::min(run_ + 1, kLearnt) : 0;
  order_ = order;
  const std::int64_t span_ns = last_ns() - first_ns();
  const auto is_calm = [this](std::int64_t off_ns) { return 8 * std::abs(off_ns) <= period_ns_; };
  if (run_ == 0 || !is_calm(span_ns - span_ns_) ||
      (start_ns_ != 0 && !is_calm(first_ns() - start_ns_ - period_ns_))) {
    calm_ = 0;
  } else {
    calm_ = std::min(calm_ + 1, kCalm);
  }
  span_ns_ = run_ == 0 ? span_ns : span_ns_ + (span_ns - span_ns_) / 8;
  if (start_ns_ != 0) learn_period(first_ns() - start_ns_);
}

void CanCycle::learn_period(std::int64_t interval_ns) {
  if (period_ns_ == 0) period_ns_ = interval_ns;
  // Held up and made up for: no period.
  if (2 * std::abs(interval_ns - period_ns_) <= period_ns_) {
    period_ns_ += (interval_ns - period_ns_) / 8;
    odd_ = 0;
  } else if (++odd_ >= kLearnt) {
    period_ns_ = interval_ns;
    odd_ = run_ = 0;
  }
}

bool CanCycle::close_incomplete() {
  const auto lacks = static_cast<std::uint16_t>(axes_ & ~gathered_);
  const bool was_cyclic = is_cyclic() || (may_learn_ && synced_ >= kLearnt);
  clear();
  start_ns_ = 0;
  widest_ns_ = 0;
  shifts_ = 0;
  sync_before_ = false;
  if (was_cyclic && ++pending_ <= kMostIncomplete) {
    pending_axes_ = static_cast<std::uint16_t>(pending_axes_ | lacks);
    for (std::size_t i = 0; i < kMaxPositions; ++i) missed_[i] += lacks >> i & 1;
    return true;
  }
  run_ = synced_ = pending_ = 0;
  pending_axes_ = 0;
  return false;
}

}  // namespace kerf
