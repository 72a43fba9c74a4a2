#include "stock/cutter/scan.h"

#include <cmath>
#include <optional>

#include "base/translate.h"

namespace kerf {
Result<double> parse_within(std::string_view name, std::string_view text, double low, double high,
                            std::string_view unit) {
  const std::optional<double> value = parse_decimal(text);
  if (!value) return Error{trf("{}: '{}' is not a number", name, shown(text))};
  if (*value < low || *value > high) {
    return Error{trf("{}: {} is not allowed; must be from {} to {} ({})", name, number_text(*value),
                     number_text(low), number_text(high), unit)};
  }
  return *value;
}

Result<double> parse_length(std::string_view name, std::string_view text, double low_mm,
                            double high_mm, LengthUnit unit) {
  if (unit == LengthUnit::kMm) return parse_within(name, text, low_mm, high_mm, name_of(unit));
  const std::optional<double> value = parse_decimal(text);
  if (!value) return Error{trf("{}: '{}' is not a number", name, shown(text))};
  const double mm = to_mm(*value, unit);
  if (mm < low_mm || mm > high_mm) {
    return Error{trf("{}: {} is not allowed; must be from {:.4g} to {:.4g} ({})", name,
                     number_text(*value), from_mm(low_mm, unit), from_mm(high_mm, unit),
                     name_of(unit))};
  }
  return mm;
}

std::string length_number(double mm, LengthUnit unit) {
  if (unit == LengthUnit::kMm) return number_text(mm);
  const double value = from_mm(mm, unit);
  const double steps = std::abs(value) < 0.1 ? 1e6 : 1e4;
  return number_text(std::round(value * steps) / steps);
}

}  // namespace kerf
