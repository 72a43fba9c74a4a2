#include "stock/cutter/tool_number.h"

#include <algorithm>
#include <charconv>

#include "base/text_scan.h"

namespace kerf {
namespace {

/// V-bits are named by their angle: "60 v-bit".
constexpr int kLeastVeeAngle_deg = 20;

/// "6 mm", "3 flute", "10 x 25", "60 v-bit": what follows counts or measures something.
bool is_measured(int number, std::string_view rest) {
  if (rest.empty()) return false;
  if (std::string_view("\"'*/\xc2\xb0\xe2").find(rest.front()) != std::string_view::npos)
    return true;
  const auto end = std::find_if_not(rest.begin(), rest.end(), is_letter);
  const std::string_view word = rest.substr(0, static_cast<std::size_t>(end - rest.begin()));
  for (const std::string_view whole : {"mm", "cm", "in", "inch", "inches", "fl", "z", "x"}) {
    if (word == whole) return true;
  }
  for (const std::string_view begin : {"millim", "dia", "deg", "flute", "tooth", "teeth"}) {
    if (word.starts_with(begin)) return true;
  }
  return number >= kLeastVeeAngle_deg && word.starts_with("v") && !contains(rest, "deg");
}

}  // namespace

std::string_view without_leading(std::string_view text, std::string_view characters) {
  const std::size_t first = text.find_first_not_of(characters);
  return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

std::optional<int> take_integer(std::string_view& text) {
  int value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || !is_digit(text.front()) || error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return value;
}

std::optional<NumberedText> split_tool_number(std::string_view lower) {
  std::string_view text = lower;
  const bool word = text.starts_with("tool");
  bool is_numbered = false;  // "tool #1", "tools: t05"
  if (word) {
    text.remove_prefix(text.starts_with("tools:") ? 5 : 4);
    const std::string_view after = without_leading(text, " \t:#");
    const std::string_view signs = text.substr(0, text.size() - after.size());
    is_numbered = signs.ends_with('#') || (signs.starts_with(':') && after.starts_with('t'));
    text = after;
  }
  if (text.starts_with("t")) {
    text.remove_prefix(1);
  } else if (!word) {
    return std::nullopt;
  }
  const std::optional<int> tool = take_integer(text);
  if (!tool) return std::nullopt;
  NumberedText numbered;
  numbered.tool = *tool;
  const bool touches = !text.empty() && text.front() != ' ' && text.front() != '\t';
  text = without_leading(text, " \t");
  if (!text.empty() && std::string_view(":=|-").find(text.front()) != std::string_view::npos) {
    numbered.separator = text.front();
    text = without_leading(text.substr(1), " \t>");
  } else if (touches || (word && !is_numbered)) {
    return std::nullopt;
  }
  numbered.rest = text;
  return numbered;
}

std::optional<NumberedText> split_bare_number(std::string_view lower) {
  constexpr std::string_view kWord = "tool:";
  if (!lower.starts_with(kWord)) return std::nullopt;
  std::string_view text = without_leading(lower.substr(kWord.size()), " \t");
  const std::optional<int> tool = take_integer(text);
  if (!tool || (!text.empty() && text.front() != ' ' && text.front() != '\t')) return std::nullopt;
  NumberedText numbered;
  numbered.tool = *tool;
  numbered.rest = without_leading(text, " \t");
  if (is_measured(*tool, numbered.rest)) return std::nullopt;
  return numbered;
}

int tool_named_in(std::string_view lower) {
  int named = -1;
  for (std::size_t at = lower.find('t'); at != std::string_view::npos;
       at = lower.find('t', at + 1)) {
    if (at > 0 && (is_letter(lower[at - 1]) || is_digit(lower[at - 1]))) continue;
    std::string_view rest = lower.substr(at + 1);
    if (rest.starts_with("ool")) {
      rest = without_leading(rest.substr(3), " \t");
      if (rest.starts_with("no")) rest = without_leading(rest.substr(2), ". \t");
      rest = without_leading(rest, "# \t");
      // "tool 6mm", "tool 1/4": a size.
      const std::size_t end = std::min(rest.find_first_not_of("0123456789"), rest.size());
      const std::string_view behind = rest.substr(end);
      if (behind.starts_with('.') || behind.starts_with('/') || behind.starts_with('"') ||
          behind.starts_with("mm") || behind.starts_with(" mm") || behind.starts_with(" in")) {
        continue;
      }
    }
    const std::optional<int> tool = take_integer(rest);
    if (!tool || (!rest.empty() && is_letter(rest.front()))) continue;
    if (named >= 0 && named != *tool) return kSeveralTools;
    named = *tool;
  }
  return named;
}

}  // namespace kerf
