// interp_bridge/unknown_sum.h - what nobody has said of a coordinate.
#pragma once

#include <array>
#include <cstdint>

namespace kerf {

/// A sum of amounts that nobody knows, each with its sign; empty where all is known. Of two places
/// of one axis with equal sums it is known how far apart they are: by the interpreter's numbers,
/// which are wrong by the same amount for both. A value; does not allocate.
class UnknownSum {
 public:
  UnknownSum() = default;
  /// One amount. `number`: from 1 up, another for each. `doubtful`: of a place that says nothing of
  /// the workpiece, as one that a probe has met.
  static UnknownSum of(int number, bool doubtful);

  /// Sums of too many amounts equal nothing, not even themselves.
  bool operator==(const UnknownSum& other) const {
    if (count_ != other.count_ || count_ < 0) return false;
    return count_ == 0 || terms_ == other.terms_;
  }
  bool operator!=(const UnknownSum& other) const { return !(*this == other); }
  UnknownSum operator+(const UnknownSum& other) const { return plus(other, 1); }
  UnknownSum operator-(const UnknownSum& other) const { return plus(other, -1); }
  /// One of its amounts is, or they are too many.
  bool is_doubtful() const { return count_ != 0 && has_doubtful_term(); }

 private:
  bool has_doubtful_term() const;
  static constexpr int kMost = 4;
  UnknownSum plus(const UnknownSum& other, int sign) const;

  std::array<std::int32_t, kMost> terms_{};  ///< 2 * number + doubtful, with the sign; rising
  std::int8_t count_ = 0;                    ///< -1: too many
};

}  // namespace kerf
