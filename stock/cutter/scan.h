// stock/cutter/scan.h - small pieces of text scanning shared by SHAPE, --stock and comment readers.
// Locale plays no part.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/length_unit.h"
#include "base/result.h"

namespace kerf {

std::string_view trim(std::string_view text);
/// ASCII only.
std::string to_lower(std::string_view text);
/// Parts between separators; always at least one.
std::vector<std::string_view> split(std::string_view text, char separator);
/// Words between blanks and tabs.
std::vector<std::string_view> words_of(std::string_view text);

/// Text as a message shows it: control characters as '?', long text cut after 60 characters with
/// "...".
std::string shown(std::string_view text);

/// The whole text as a decimal number ("12", "-0.5", "+3.", "1e-3"); nullopt for anything else,
/// also for "nan" and "inf" and numbers beyond double.
std::optional<double> parse_decimal(std::string_view text);

/// The number in `text` if it lies within [low, high]. Otherwise an error:
///     diameter D: 'abc' is not a number
///     diameter D: 0 is not allowed; must be from 0.001 to 1000 (mm)
Result<double> parse_within(std::string_view name, std::string_view text, double low, double high,
                            std::string_view unit);

/// The same for a length in `unit`, given and told; the bounds and the result are mm.
Result<double> parse_length(std::string_view name, std::string_view text, double low_mm,
                            double high_mm, LengthUnit unit);

/// "; did you mean 'flat'?" for the candidate within two edits of `text`, "." if there is none:
/// ends a sentence.
std::string did_you_mean(std::string_view text, std::span<const std::string_view> candidates);

/// Shortest text that reads back as the same value: "10", "0.1".
std::string number_text(double value);

/// A length for SHAPE and --stock texts in `unit`: of mm the shortest text, of inches as much of it
/// as counts (0.0001 in, below 0.1 in two digits more).
std::string length_number(double mm, LengthUnit unit);

}  // namespace kerf
