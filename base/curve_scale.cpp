#include "base/curve_scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

namespace kerf {
namespace {

constexpr double kUsualShare = 0.99;
/// Above a line for the limit.
constexpr double kAboveLimit = 1.1;

double greatest(std::span<const float> values) {
  return values.empty() ? 0.0
                        : static_cast<double>(*std::max_element(values.begin(), values.end()));
}

/// What is not exceeded in 99 % of the columns that have a value.
double usual(std::span<const float> values) {
  std::vector<float> present;
  std::copy_if(values.begin(), values.end(), std::back_inserter(present),
               [](float value) { return value > 0.0f; });
  if (present.empty()) return 0.0;
  // Of less than a hundred columns all.
  const auto at =
      static_cast<std::ptrdiff_t>(std::ceil(kUsualShare * static_cast<double>(present.size())) - 1);
  std::nth_element(present.begin(), present.begin() + at, present.end());
  return static_cast<double>(present[static_cast<std::size_t>(at)]);
}

}  // namespace

CurveScale scale_of(std::span<const float> values, std::span<const float> high, double limit) {
  const std::span<const float> ends = high.size() == values.size() ? high : values;
  CurveScale scale;
  scale.most = greatest(values);
  scale.most_high = greatest(ends);
  if (!(scale.most > 0.0)) return scale;
  const double most_usual = usual(ends);
  scale.top = scale.most_high > kFarPeak * most_usual ? most_usual : scale.most_high;
  if (limit > 0.0 && limit <= kFarLimit * scale.top)
    scale.top = std::max(scale.top, kAboveLimit * limit);
  scale.is_clipped = scale.most > scale.top;
  return scale;
}

}  // namespace kerf
