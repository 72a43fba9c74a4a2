// interp_bridge/kerf_interp/plain_number.h - decimal numbers as programs write them, to the bit.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace kerf::interp {

/// Reads `text` if all of it is a plain number: a sign or none, at most 18 digits, a point or none,
/// less than 2^53 without its point. Such a number is a quotient of two whole numbers which are
/// both exact doubles, and a quotient is rounded once: the result is the double nearest to the
/// decimal number, as strtod() has it (W. D. Clinger, "How to read floating point numbers
/// accurately", 1990). False: it is not plain, which does not say that it is wrong.
inline bool read_plain_number(std::string_view text, double& value) {
  constexpr std::array<double, 19> kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                              1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                              1e14, 1e15, 1e16, 1e17, 1e18};
  constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
  constexpr std::size_t kMostDigits = 18;  // of which none overflows 64 bits
  const bool negative = !text.empty() && text.front() == '-';
  if (negative || (!text.empty() && text.front() == '+')) text.remove_prefix(1);
  if (text.empty() || text.size() > kMostDigits) return false;
  std::uint64_t digits = 0;
  std::size_t count = 0, behind_point = 0;
  bool has_point = false;
  for (const char c : text) {
    if (c >= '0' && c <= '9') {
      digits = digits * 10 + static_cast<std::uint64_t>(c - '0');
      ++count;
      behind_point += has_point ? 1 : 0;
    } else if (c == '.' && !has_point) {
      has_point = true;
    } else {
      return false;
    }
  }
  if (count == 0 || digits >= kExact) return false;
  const double whole = static_cast<double>(digits);
  const double number = behind_point == 0 ? whole : whole / kPowers[behind_point];
  value = negative ? -number : number;
  return true;
}

}  // namespace kerf::interp
