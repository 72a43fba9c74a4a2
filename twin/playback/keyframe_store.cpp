#include "twin/playback/keyframe_store.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace kerf {
namespace {

/// A new keyframe between two others must leave at least this share of their gap on either side.
constexpr double kLeastShare = 0.25;
/// Beyond the last keyframe they need not come closer than this share of the worst gap: they would
/// not last.
constexpr double kEndShare = 0.125;

}  // namespace

std::size_t KeyframeStore::upper_bound(std::size_t motion) const {
  const auto found = std::upper_bound(
      frames_.begin(), frames_.end(), motion,
      [](std::size_t place, const Keyframe& frame) { return place < frame.motion; });
  return static_cast<std::size_t>(found - frames_.begin());
}

const Keyframe* KeyframeStore::at_or_before(std::size_t motion) const {
  const std::size_t next = upper_bound(motion);
  return next == 0 ? nullptr : &frames_[next - 1];
}

double KeyframeStore::worst_s() const {
  double worst = 0;
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    worst = std::max(worst, frames_[i].cost_s - frames_[i - 1].cost_s);
  }
  return worst;
}

bool KeyframeStore::wants(std::size_t motion, double cost_s) const {
  const std::size_t next = upper_bound(motion);
  if (next == 0) return true;
  const Keyframe& before = frames_[next - 1];
  if (before.motion == motion) return false;
  const double here = cost_s - before.cost_s;
  if (next == frames_.size()) return here >= std::max(finest_s_, kEndShare * worst_s());
  const double gap = frames_[next].cost_s - before.cost_s;
  if (gap < 2 * finest_s_ || std::min(here, gap - here) < kLeastShare * gap) return false;
  return gap > 0.5 * worst_s();
}

void KeyframeStore::add(std::size_t motion, double cost_s, std::unique_ptr<StockModel> stock) {
  const std::size_t next = upper_bound(motion);
  assert(next == 0 || frames_[next - 1].motion != motion);
  frames_.insert(frames_.begin() + static_cast<std::ptrdiff_t>(next),
                 Keyframe{motion, cost_s, std::move(stock), 0});
  if (next > 0) frames_[next - 1].is_packed = false;
  // Some could not be when they came: others have let go of what they shared with them since.
  for (std::size_t n = 0; n < frames_.size(); ++n) {
    if (!frames_[n].is_packed) pack(n);
  }
  thin();
}

void KeyframeStore::pack(std::size_t frame) {
  std::vector<StockModel*> copies;
  copies.reserve(frames_.size());
  for (const Keyframe& one : frames_) copies.push_back(one.stock.get());
  frames_[frame].is_packed = copies[frame]->pack(copies, frame);
  for (std::size_t n = frame > 0 ? frame - 1 : 0; n < frame + 2; ++n) measure(n);
}

/// The first one is there anyway.
void KeyframeStore::measure(std::size_t frame) {
  if (frame == 0 || frame >= frames_.size()) return;
  Keyframe& one = frames_[frame];
  const StockModel* const after =
      frame + 1 < frames_.size() ? frames_[frame + 1].stock.get() : nullptr;
  bytes_ -= one.bytes;
  one.bytes = one.stock->kept_bytes(*frames_[frame - 1].stock, after);
  bytes_ += one.bytes;
}

/// The gap that is left by the one that goes must be the smallest. The last one stays as long as
/// others can go: behind it lies all that has not been cut before.
void KeyframeStore::thin() {
  while (bytes_ > budget_bytes_ && frames_.size() > 1) {
    std::size_t least = frames_.size() - 1;
    double least_gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i + 1 < frames_.size(); ++i) {
      const double gap = frames_[i + 1].cost_s - frames_[i - 1].cost_s;
      if (gap < least_gap) {
        least_gap = gap;
        least = i;
      }
    }
    bytes_ -= frames_[least].bytes;
    frames_.erase(frames_.begin() + static_cast<std::ptrdiff_t>(least));
    // What its neighbours shared with it alone is their own now.
    measure(least - 1);
    measure(least);
  }
}

}  // namespace kerf
