// machine_io/logs/number_text.h - numbers in logs: exact, from any locale, nothing allocated.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/text_scan.h"

namespace kerf {

/// The whole of `text` as a number; "+1", "1e3", "nan" and "inf" are some.
inline bool parse_double(std::string_view text, double& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  // Out of range is also what a number too small for a double gives; a log that has such is broken.
  return read_number(text, value);
}

/// The whole of `text` as a count: "17", also "17.0" as spreadsheets write it; "-1" is one.
bool parse_count(std::string_view text, std::int32_t& value);

/// A time in units of `ns_per_unit` (1, 1000, 10^6 or 10^9) as ns: exact to the ns where it is
/// written with digits ("1795210989.363816"), further decimals are rounded; "1.5e3" by way of a
/// double. False: not a number, or more than 292 years.
bool parse_stamp(std::string_view text, std::int64_t ns_per_unit, std::int64_t& time_ns);

}  // namespace kerf
