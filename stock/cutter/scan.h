// stock/cutter/scan.h - numbers with their bounds and units, as SHAPE, --stock and comment readers
// take and tell them. Locale plays no part.
#pragma once

#include <string>
#include <string_view>

#include "base/length_unit.h"
#include "base/result.h"
#include "base/text_scan.h"

namespace kerf {

/// The number in `text` if it lies within [low, high]. Otherwise an error:
///     diameter D: 'abc' is not a number
///     diameter D: 0 is not allowed; must be from 0.001 to 1000 (mm)
Result<double> parse_within(std::string_view name, std::string_view text, double low, double high,
                            std::string_view unit);

/// The same for a length in `unit`, given and told; the bounds and the result are mm.
Result<double> parse_length(std::string_view name, std::string_view text, double low_mm,
                            double high_mm, LengthUnit unit);

/// A length for SHAPE and --stock texts in `unit`: of mm the shortest text, of inches as much of it
/// as counts (0.0001 in, below 0.1 in two digits more).
std::string length_number(double mm, LengthUnit unit);

}  // namespace kerf
