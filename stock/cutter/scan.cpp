#include "stock/cutter/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace kerf {
namespace {

constexpr std::size_t kLongestShown = 60;
/// Beyond this a suggestion is a guess at something else.
constexpr std::size_t kMostEdits = 2;

/// Levenshtein distance.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t swap = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, swap});
    }
  }
  return row.back();
}

}  // namespace

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string to_lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlanks = " \t\r";
  std::size_t at = text.find_first_not_of(kBlanks);
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::string shown(std::string_view text) {
  std::string out(text.substr(0, kLongestShown));
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  if (text.size() > kLongestShown) out += "...";
  return out;
}

std::optional<double> parse_decimal(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

Result<double> parse_within(std::string_view name, std::string_view text, double low, double high,
                            std::string_view unit) {
  const std::optional<double> value = parse_decimal(text);
  if (!value) return Error{fmt::format("{}: '{}' is not a number", name, shown(text))};
  if (*value < low || *value > high) {
    return Error{fmt::format("{}: {} is not allowed; must be from {} to {} ({})", name,
                             number_text(*value), number_text(low), number_text(high), unit)};
  }
  return *value;
}

Result<double> parse_length(std::string_view name, std::string_view text, double low_mm,
                            double high_mm, LengthUnit unit) {
  if (unit == LengthUnit::kMm) return parse_within(name, text, low_mm, high_mm, name_of(unit));
  const std::optional<double> value = parse_decimal(text);
  if (!value) return Error{fmt::format("{}: '{}' is not a number", name, shown(text))};
  const double mm = to_mm(*value, unit);
  if (mm < low_mm || mm > high_mm) {
    return Error{fmt::format("{}: {} is not allowed; must be from {:.4g} to {:.4g} ({})", name,
                             number_text(*value), from_mm(low_mm, unit), from_mm(high_mm, unit),
                             name_of(unit))};
  }
  return mm;
}

std::string did_you_mean(std::string_view text, std::span<const std::string_view> candidates) {
  std::size_t best = kMostEdits + 1;
  std::string_view match;
  const std::string lower = to_lower(text.substr(0, kLongestShown));
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edits(lower, candidate);
    if (distance < best && distance < candidate.size()) {
      best = distance;
      match = candidate;
    }
  }
  return match.empty() ? "." : fmt::format("; did you mean '{}'?", match);
}

std::string number_text(double value) { return fmt::format("{}", value == 0 ? 0.0 : value); }

std::string length_number(double mm, LengthUnit unit) {
  if (unit == LengthUnit::kMm) return number_text(mm);
  const double value = from_mm(mm, unit);
  const double steps = std::abs(value) < 0.1 ? 1e6 : 1e4;
  return number_text(std::round(value * steps) / steps);
}

}  // namespace kerf
