#include "machine_io/logs/number_text.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace kerf {
namespace {

constexpr std::uint64_t kLargestTime =
    static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());

bool stamp_from_double(std::string_view text, std::int64_t ns_per_unit, std::int64_t& time_ns) {
  double value = 0.0;
  if (!parse_double(text, value)) return false;
  value = std::round(value * static_cast<double>(ns_per_unit));
  if (!(std::abs(value) < 9.2e18)) return false;
  time_ns = static_cast<std::int64_t>(value);
  return true;
}

/// Digits behind the point as ns below one unit; the next digit rounds.
bool take_fraction(std::string_view digits, std::int64_t ns_per_unit, std::uint64_t& ns) {
  ns = 0;
  std::uint64_t weight = static_cast<std::uint64_t>(ns_per_unit);
  bool is_rounded = false;
  for (const char c : digits) {
    if (!is_digit(c)) return false;
    const auto digit = static_cast<std::uint64_t>(c - '0');
    if (weight >= 10) {
      weight /= 10;
      ns += digit * weight;
    } else if (!is_rounded) {
      is_rounded = true;
      ns += digit >= 5 ? 1 : 0;
    }
  }
  return true;
}

}  // namespace

bool parse_count(std::string_view text, std::int32_t& value) {
  if (read_number(text, value)) return true;
  double number = 0.0;
  if (!parse_double(text, number) || number != std::floor(number)) return false;
  if (!(std::abs(number) <= std::numeric_limits<std::int32_t>::max())) return false;
  value = static_cast<std::int32_t>(number);
  return true;
}

bool parse_stamp(std::string_view text, std::int64_t ns_per_unit, std::int64_t& time_ns) {
  std::string_view rest = text;
  const bool is_negative = !rest.empty() && rest[0] == '-';
  if (!rest.empty() && (is_negative || rest[0] == '+')) rest.remove_prefix(1);
  std::uint64_t whole = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), whole);
  if (error == std::errc::result_out_of_range) return false;
  const bool has_whole = error == std::errc();
  if (has_whole) rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));

  std::uint64_t fraction_ns = 0;
  if (!rest.empty()) {
    if (rest[0] != '.') return has_whole && stamp_from_double(text, ns_per_unit, time_ns);
    rest.remove_prefix(1);
    if (rest.empty() && !has_whole) return false;
    if (!take_fraction(rest, ns_per_unit, fraction_ns)) {
      return stamp_from_double(text, ns_per_unit, time_ns);
    }
  } else if (!has_whole) {
    return false;
  }
  const auto unit = static_cast<std::uint64_t>(ns_per_unit);
  if (whole > (kLargestTime - fraction_ns) / unit) return false;
  const auto magnitude = static_cast<std::int64_t>(whole * unit + fraction_ns);
  time_ns = is_negative ? -magnitude : magnitude;
  return true;
}

}  // namespace kerf
