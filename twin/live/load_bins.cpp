#include "twin/live/load_bins.h"

#include <algorithm>

namespace kerf {
namespace {

/// Nothing lasts so long; what says so is a clock at fault.
constexpr std::int64_t kMostBins = 40'000;

}  // namespace

LoadBin* LoadBins::at(std::int64_t number) {
  if (!is_begun_) {
    is_begun_ = true;
    first_ = std::max<std::int64_t>(first_, number);
  }
  if (number < first_ || number - first_ > kMostBins) return nullptr;
  while (first_ + static_cast<std::int64_t>(bins_.size()) <= number) bins_.emplace_back();
  return &bins_[static_cast<std::size_t>(number - first_)];
}

const LoadBin* LoadBins::find(std::int64_t number) const {
  if (number < first_ || number - first_ >= static_cast<std::int64_t>(bins_.size())) return nullptr;
  return &bins_[static_cast<std::size_t>(number - first_)];
}

void LoadBins::forget_before(std::int64_t number) {
  while (!bins_.empty() && first_ < number) {
    bins_.pop_front();
    ++first_;
  }
  first_ = std::max(first_, number);
}

}  // namespace kerf
