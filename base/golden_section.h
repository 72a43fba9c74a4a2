// base/golden_section.h - where a function that falls and then rises is least.
#pragma once

#include <algorithm>
#include <functional>

namespace kerf {

/// What golden_section() has found.
struct LeastWithin {
  double low = 0, high = 0;  ///< the least value is between them
  double least = 0;          ///< of all that were asked for
  double middle() const { return 0.5 * (low + high); }
};

/// Narrows [low, high] `steps` times by the golden section (J. Kiefer, 1953), for steps + 2 values
/// of `f`. `first(a, b)`: of two inner values, that the least one is not beyond the second. Where
/// `f` has several lowest places it finds one of them.
template <class F, class First = std::less_equal<>>
LeastWithin golden_section(const F& f, double low, double high, int steps, First first = {}) {
  constexpr double kGolden = 0.6180339887498949;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double at_a = f(a), at_b = f(b);
  for (int i = 0; i < steps; ++i) {
    if (first(at_a, at_b)) {
      high = b, b = a, at_b = at_a;
      a = high - kGolden * (high - low), at_a = f(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + kGolden * (high - low), at_b = f(b);
    }
  }
  return {low, high, std::min(at_a, at_b)};
}

}  // namespace kerf
