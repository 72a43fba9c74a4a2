#include "twin/cli/option_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

/// "mesh, raycast or csg"
std::string either(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? tr(" or ") : ", ";
    text += words[i];
  }
  return text;
}

std::string refusal_of(const Setting& setting, const std::string& text) {
  const std::vector<std::string> words = parts_of(setting.words);
  if (*setting.refusal == 0) return trf("'{}' is not allowed; must be {}", text, either(words));
  const std::string all = fmt::format("{}", fmt::join(words, ", "));
  return formatted(setting.refusal, tr(setting.refusal), fmt::make_format_args(text, all));
}

}  // namespace

void add_fault(std::string_view option, const std::string& message, std::string hint,
               Diagnostics& diagnostics) {
  Diagnostic d;
  d.message = fmt::format("{}: {}", option, message);
  d.hint = std::move(hint);
  diagnostics.push_back(std::move(d));
}

OptionReader::OptionReader(Diagnostics& diagnostics, OptionLayers layers)
    : diagnostics_(diagnostics), layers_(std::move(layers)) {
  unit_ = word("--units") == 1 ? LengthUnit::kInch : LengthUnit::kMm;
}

void OptionReader::fault(std::string_view option, const std::string& message, std::string hint) {
  add_fault(option, message, std::move(hint), diagnostics_);
}

const std::vector<std::string>& OptionReader::texts(std::string_view option) const {
  static const std::vector<std::string> kNone;
  return layers_.written == nullptr ? kNone : layers_.written->texts(option);
}

LengthUnit OptionReader::unit_of(const ChosenValue& value) const {
  return value.from == ValueFrom::kCommandLine ? unit_ : LengthUnit::kMm;
}

double OptionReader::checked(std::string_view option, const ChosenValue& value, LengthUnit unit,
                             double none) {
  if (value.text.empty()) return none;
  const Setting& row = setting_of(option, layers_.command);
  const double least = from_mm(row.least, unit);
  const double most = from_mm(row.most, unit);
  double number = 0;
  const char* const end = value.text.data() + value.text.size();
  const auto [stop, error] = std::from_chars(value.text.data(), end, number);
  const std::string allowed = trf("must be {} {:g} and at most {:g} ({})",
                                  row.least_excluded ? tr("above") : tr("at least"), least, most,
                                  row.is_length() ? name_of(unit) : tr(row.unit));
  if (error != std::errc() || stop != end || !std::isfinite(number)) {
    fault(option, trf("'{}' is not a number; {}", value.text, allowed));
    return none;
  }
  if (number < least || number > most || (row.least_excluded && number == least)) {
    fault(option, trf("{} is not allowed; {}", value.text, allowed));
    return none;
  }
  return number;
}

double OptionReader::number(std::string_view option, double none) {
  return checked(option, choose(option), LengthUnit::kMm, none);
}

double OptionReader::length_mm(std::string_view option, double none_mm) {
  const ChosenValue value = choose(option);
  const LengthUnit unit = unit_of(value);
  const std::size_t faults = diagnostics_.size();
  if (value.text.empty()) return none_mm;
  const double length = checked(option, value, unit, 0);
  return diagnostics_.size() > faults ? none_mm : to_mm(length, unit);
}

double OptionReader::whole_number(std::string_view option, double none) {
  const double value = number(option, none);
  if (value == std::floor(value)) return value;
  fault(option, trf("{} is not a whole number", text(option)));
  return none;
}

int OptionReader::word(std::string_view option) {
  const ChosenValue value = choose(option);
  if (value.text.empty()) return -1;
  const Setting& row = setting_of(option, layers_.command);
  const std::vector<std::string> words = parts_of(row.words);
  const auto at = std::find(words.begin(), words.end(), value.text);
  if (at != words.end()) return static_cast<int>(at - words.begin());
  fault(option, refusal_of(row, value.text));
  return -1;
}

void OptionReader::ini_says(std::string_view option, std::string text) {
  layers_.ini.insert_or_assign(std::string(option), std::move(text));
}

}  // namespace kerf
