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

/// Memory of the tiles that `stock` does not share with the keyframe before it.
std::size_t bytes_beside(const StockModel& stock, const StockModel& before) {
  const std::size_t tiles = stock.tile_count();
  const std::size_t tile_bytes =
      (stock.cell_count() + tiles - 1) / tiles * sizeof(float) * (stock.keeps_cut_ids() ? 2 : 1);
  return stock.differing_tiles(before).size() * tile_bytes;
}

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

void KeyframeStore::add(std::size_t motion, double cost_s,
                        std::unique_ptr<const StockModel> stock) {
  const std::size_t next = upper_bound(motion);
  Keyframe frame{motion, cost_s, std::move(stock), 0};
  if (next > 0) {
    assert(frames_[next - 1].motion != motion);
    frame.bytes = bytes_beside(*frame.stock, *frames_[next - 1].stock);
  }
  bytes_ += frame.bytes;
  frames_.insert(frames_.begin() + static_cast<std::ptrdiff_t>(next), std::move(frame));
  thin();
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
    if (least == frames_.size()) continue;
    // What its follower shared with it alone is now the follower's own.
    Keyframe& follower = frames_[least];
    const std::size_t own =
        std::max(follower.bytes, bytes_beside(*follower.stock, *frames_[least - 1].stock));
    bytes_ += own - follower.bytes;
    follower.bytes = own;
  }
}

}  // namespace kerf
