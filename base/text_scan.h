// base/text_scan.h - small pieces of text scanning that all readers share. ASCII alone, whatever
// the locale; any bytes are accepted; nothing throws but for memory.
#pragma once

#include <charconv>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace kerf {

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
constexpr char to_lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
constexpr char to_upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

/// Between the words of a line.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }
/// The same of a line that DOS may have ended.
constexpr bool is_line_blank(char c) { return is_blank(c) || c == '\r'; }
/// Between the words of a text of several lines.
constexpr bool is_text_blank(char c) { return is_line_blank(c) || c == '\n'; }
/// As std::isspace() has it: form feeds and vertical tabs, too.
constexpr bool is_space(char c) { return is_text_blank(c) || c == '\f' || c == '\v'; }

/// `text` without what `is_cut` names at its two ends.
template <class IsCut>
constexpr std::string_view trim(std::string_view text, IsCut is_cut) {
  while (!text.empty() && is_cut(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_cut(text.back())) text.remove_suffix(1);
  return text;
}
constexpr std::string_view trim(std::string_view text) { return trim(text, is_text_blank); }

std::string to_lower(std::string_view text);
std::string to_upper(std::string_view text);

constexpr bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// `text` up to its first newline, which is taken off with it.
constexpr std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// True: `text` began with `prefix`, and is now what follows.
constexpr bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

/// Parts between separators; always at least one.
std::vector<std::string_view> split(std::string_view text, char separator);
/// Words between is_line_blank().
std::vector<std::string_view> words_of(std::string_view text);

/// The whole of `text` as a number, as std::from_chars() reads it (no '+', no blanks, "nan" and
/// "inf" if a floating one is asked for); `base` is of integers. False: it is none, or beyond the
/// type; `value` may then hold what the front of the text is.
template <class Number, class... Base>
bool read_number(std::string_view text, Number& value, Base... base) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, base...);
  return error == std::errc() && stop == end;
}

/// The whole text as a decimal number ("12", "-0.5", "+3.", "1e-3"); nullopt for anything else,
/// also for "nan" and "inf" and numbers beyond double.
std::optional<double> parse_decimal(std::string_view text);

/// Shortest text that reads back as the same value: "10", "0.1".
std::string number_text(double value);

/// Text as a message shows it: control characters as '?', long text cut after 60 characters with
/// "...".
std::string shown(std::string_view text);

/// One of the parts stands in the text.
bool contains_any(std::string_view text, std::initializer_list<std::string_view> parts);
/// `word` with no letter on either side.
bool contains_word(std::string_view text, std::string_view word);

}  // namespace kerf
