// base/curve_scale.h - how high a picture of values over time reaches.
#pragma once

#include <span>

namespace kerf {

struct CurveScale {
  double top = 0;                  ///< where the scale ends; 0: there is nothing
  double most = 0, most_high = 0;  ///< the greatest value, and end of a range
  bool is_clipped = false;         ///< some values are above the top
};

/// Of one value a column of time. A peak that lasts for a moment must not flatten all the rest: the
/// scale ends at what is not exceeded in 99 % of the columns that have a value, if the greatest is
/// more than kFarPeak times that. `high`: ends of ranges, which are seen as well; empty: there are
/// none. A limit (0: none) is seen where it is no more than kFarLimit times the rest.
CurveScale scale_of(std::span<const float> values, std::span<const float> high = {},
                    double limit = 0);

inline constexpr double kFarPeak = 1.5, kFarLimit = 2.0;

}  // namespace kerf
