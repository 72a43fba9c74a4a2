#include "twin/process/run_curve.h"

#include <algorithm>
#include <cmath>

#include "interp_bridge/motion_kinds.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {

void RunCurve::double_step() {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Column column = columns_[i];
    Column& into = columns_[i / 2];
    if (i % 2 == 0) {
      into = column;
      continue;
    }
    into.removed_mm3 += column.removed_mm3;
    into.feed_mm += column.feed_mm;
    into.feed_s += column.feed_s;
    into.turns += column.turns;
    if (column.motion_s > into.motion_s) {
      into.source = column.source;
      into.at_mm = column.at_mm;
      into.motion_s = column.motion_s;
    }
  }
  columns_.resize((columns_.size() + 1) / 2);
  step_s_ *= 2;
}

void RunCurve::add(const Share& share) {
  const double end_s = share.start_s + std::max(0.0, share.duration_s);
  if (!(share.start_s >= 0) || !std::isfinite(end_s)) return;
  while (end_s >= step_s_ * static_cast<double>(kMost)) double_step();
  const auto first = static_cast<std::size_t>(share.start_s / step_s_);
  const auto last = static_cast<std::size_t>(end_s / step_s_);
  if (columns_.size() <= last) columns_.resize(last + 1);
  for (std::size_t i = first; i <= last; ++i) {
    const double from_s = std::max(share.start_s, static_cast<double>(i) * step_s_);
    const double to_s = std::min(end_s, static_cast<double>(i + 1) * step_s_);
    const double seconds = std::max(0.0, to_s - from_s);
    const double part = share.duration_s > 0 ? seconds / share.duration_s : 1;
    Column& column = columns_[i];
    column.removed_mm3 += part * share.removed_mm3;
    if (share.feed_mm > 0) {
      column.feed_mm += part * share.feed_mm;
      column.feed_s += seconds;
    }
    column.turns += share.rpm * seconds / 60;
    if (share.motion != nullptr && seconds > column.motion_s) {
      const double middle_s = 0.5 * (from_s + to_s) - share.start_s;
      column.source = share.motion->source;
      column.at_mm = point_at(*share.motion, middle_s / share.duration_s);
      column.motion_s = seconds;
    }
    if (share.duration_s <= 0) break;
  }
}

void RunCurve::on_step(std::uint64_t number, const Motion& motion, const TimedStep& step) {
  const bool is_turning = motion.spindle != SpindleState::kStopped;
  add({step.start_s, step.duration_s, 0, is_feed(motion) ? step.length_mm : 0,
       is_turning ? motion.spindle_rpm : 0, &motion});
  waiting_.push_back({number, step.start_s, step.duration_s});
}

void RunCurve::on_cut(std::uint64_t number, double removed_mm3, double /*depth_mm*/) {
  while (!waiting_.empty() && waiting_.front().number < number) waiting_.pop_front();
  if (waiting_.empty() || waiting_.front().number != number) return;  // not reported on
  add({waiting_.front().start_s, waiting_.front().duration_s, removed_mm3});
}

}  // namespace kerf
