#include "twin/app/option_reader.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace kerf {

void OptionReader::fault(const char* option, const std::string& message, std::string hint) {
  Diagnostic d;
  d.message = fmt::format("{}: {}", option, message);
  d.hint = std::move(hint);
  diagnostics_.push_back(std::move(d));
}

double OptionReader::number(const char* option, const std::string& text, const OptionRange& range,
                            double fallback) {
  if (text.empty()) return fallback;
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const std::string allowed =
      fmt::format("must be {} {:g} and at most {:g} ({})",
                  range.least_excluded ? "above" : "at least", range.least, range.most, range.unit);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    fault(option, fmt::format("'{}' is not a number; {}", text, allowed));
    return fallback;
  }
  if (value < range.least || value > range.most || (range.least_excluded && value == range.least)) {
    fault(option, fmt::format("{} is not allowed; {}", text, allowed));
    return fallback;
  }
  return value;
}

double OptionReader::length_mm(const char* option, const std::string& text,
                               const OptionRange& range_mm, double fallback_mm) {
  if (text.empty()) return fallback_mm;
  OptionRange range = range_mm;
  range.least = from_mm(range.least, unit_);
  range.most = from_mm(range.most, unit_);
  range.unit = name_of(unit_);
  const std::size_t faults = diagnostics_.size();
  const double value = number(option, text, range, 0);
  return diagnostics_.size() > faults ? fallback_mm : to_mm(value, unit_);
}

double OptionReader::whole_number(const char* option, const std::string& text,
                                  const OptionRange& range, double fallback) {
  const double value = number(option, text, range, fallback);
  if (value == std::floor(value)) return value;
  fault(option, fmt::format("{} is not a whole number", text));
  return fallback;
}

bool OptionReader::on_off(const char* option, const std::string& text, bool fallback) {
  if (text.empty()) return fallback;
  if (text != "on" && text != "off") {
    fault(option, fmt::format("'{}' is not allowed; on or off", text));
  }
  return text == "on";
}

LengthUnit understand_units(const std::string& text, std::optional<LengthUnit> configured,
                            Diagnostics& diagnostics) {
  if (text == "inch") return LengthUnit::kInch;
  if (text == "mm") return LengthUnit::kMm;
  if (!text.empty()) {
    OptionReader(diagnostics)
        .fault("--units", fmt::format("'{}' is not allowed; must be mm or inch", text));
  }
  return configured.value_or(LengthUnit::kMm);
}

}  // namespace kerf
