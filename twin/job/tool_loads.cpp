#include "twin/job/tool_loads.h"

#include <algorithm>
#include <cmath>

namespace kerf {

void LoadSpread::add(double value, double seconds, const SourceRef& source, const Vec3& at_mm) {
  if (!(value >= 0) || !(seconds > 0)) return;
  static const double kScale = kBins / std::log(kMost / kLeast);
  const double bin = value > kLeast ? std::log(value / kLeast) * kScale : 0;
  seconds_in_[static_cast<std::size_t>(std::min(bin, kBins - 1.0))] += seconds;
  seconds_ += seconds;
  if (value <= most_) return;
  most_ = value;
  most_at_ = source;
  most_mm_ = at_mm;
}

double LoadSpread::not_above(double share) const {
  double sum = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    sum += seconds_in_[bin];
    if (sum <= 0 || sum < share * seconds_) continue;
    const double middle = (static_cast<double>(bin) + 0.5) / kBins;
    return std::min(most_, kLeast * std::exp(middle * std::log(kMost / kLeast)));
  }
  return most_;
}

}  // namespace kerf
