#include "interp_bridge/unknown_sum.h"

#include <algorithm>
#include <cstdlib>

namespace kerf {

UnknownSum UnknownSum::of(int number, bool doubtful) {
  UnknownSum sum;
  sum.terms_[0] = 2 * number + (doubtful ? 1 : 0);
  sum.count_ = 1;
  return sum;
}

UnknownSum UnknownSum::plus(const UnknownSum& other, int sign) const {
  if (other.count_ == 0) return *this;
  UnknownSum sum = *this;
  for (int i = 0; i < other.count_ && sum.count_ >= 0; ++i) {
    const std::int32_t term = sign * other.terms_[static_cast<std::size_t>(i)];
    const auto end = sum.terms_.begin() + sum.count_;
    const auto opposite = std::find(sum.terms_.begin(), end, -term);
    if (opposite != end) {
      std::copy(opposite + 1, end, opposite);
      sum.terms_[static_cast<std::size_t>(--sum.count_)] = 0;
    } else if (sum.count_ == kMost) {
      sum.count_ = -1;
    } else {
      *end = term;
      ++sum.count_;
      std::rotate(std::upper_bound(sum.terms_.begin(), end, term), end, end + 1);
    }
  }
  if (count_ < 0 || other.count_ < 0) sum.count_ = -1;
  return sum;
}

bool UnknownSum::has_doubtful_term() const {
  return count_ < 0 || std::any_of(terms_.begin(), terms_.end(),
                                   [](std::int32_t term) { return std::abs(term) % 2 == 1; });
}

}  // namespace kerf
