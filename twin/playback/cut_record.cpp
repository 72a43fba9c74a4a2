#include "twin/playback/cut_record.h"

#include <algorithm>
#include <atomic>

namespace kerf {

std::shared_ptr<const Cutter> CutRecord::cutter(std::size_t motion) const {
  const auto after =
      std::upper_bound(mounts_.begin(), mounts_.end(), motion,
                       [](std::size_t place, const Mount& mount) { return place < mount.motion; });
  return after == mounts_.begin() ? nullptr : (after - 1)->cutter;
}

std::shared_ptr<const Cutter> CutRecord::cutter_of_tool(int tool, std::size_t motion) const {
  std::shared_ptr<const Cutter> found;
  for (const Mount& mount : mounts_) {
    if (mount.tool != tool) continue;
    if (mount.motion > motion && found) break;
    found = mount.cutter;
  }
  return found;
}

double CutRecord::cost_s(std::size_t motion) const {
  const auto after =
      std::upper_bound(costs_.begin(), costs_.end(), motion,
                       [](std::size_t place, const Cost& cost) { return place < cost.motion; });
  const Cost before = after == costs_.begin() ? Cost{} : *(after - 1);
  if (after == costs_.end()) return before.cost_s;
  const double share = static_cast<double>(motion - before.motion) /
                       static_cast<double>(after->motion - before.motion);
  return before.cost_s + share * (after->cost_s - before.cost_s);
}

void CutRecord::note_cut(std::size_t motion, int tool, const Cutter& cutter) {
  flags_[motion] |= kCuts;
  const Mount* last = mounts_.empty() ? nullptr : &mounts_.back();
  if (last && last->tool == tool && last->cutter->spec() == cutter.spec()) return;
  flags_[motion] |= kMounts;
  mounts_.push_back({motion, tool, std::make_shared<const Cutter>(cutter)});
}

void CutRecord::note_cost(std::size_t motion, double cost_s) {
  if (!costs_.empty() && motion < costs_.back().motion + kCostStep) return;
  costs_.push_back({motion, cost_s});
}

void CutRecord::note_removed(std::size_t motion, double removed_mm3) {
  const std::atomic_ref sum(removed_mm3_[motion]);  // only this thread writes
  sum.store(sum.load(std::memory_order_relaxed) + static_cast<float>(removed_mm3),
            std::memory_order_relaxed);
}

std::vector<float> CutRecord::removed_mm3() const {
  std::vector<float> copy(removed_mm3_.size());
  for (std::size_t i = 0; i < copy.size(); ++i) {
    copy[i] = std::atomic_ref(removed_mm3_[i]).load(std::memory_order_relaxed);
  }
  return copy;
}

}  // namespace kerf
