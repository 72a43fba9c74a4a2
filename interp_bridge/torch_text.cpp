// What a program's text says to QtPlasmaC.
#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "base/newline_count.h"
#include "base/text_scan.h"
#include "interp_bridge/torch_setup.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxChanges = 100'000;

/// True if `text` begins with `word`, which is in lower case.
bool begins(std::string_view text, std::string_view word) {
  return text.size() >= word.size() && std::equal(word.begin(), word.end(), text.begin(),
                                                  [](char a, char b) { return a == to_lower(b); });
}

/// As the filter compares it: from `at` to the comment, in lower case, without blanks.
std::string bare(std::string_view text) {
  constexpr std::size_t kLongest = 200;
  std::string out;
  for (const char c : text.substr(0, kLongest)) {
    if (c == '(' || c == ';' || c == '\n') break;
    if (!is_line_blank(c)) out += to_lower(c);
  }
  return out;
}

/// Nothing but blanks and an N word stand before `at` in its line.
bool begins_line(std::string_view text, std::size_t at) {
  bool number = false;
  while (at > 0 && text[at - 1] != '\n') {
    const char c = text[--at];
    if (is_line_blank(c) || is_digit(c) || c == '.') continue;
    if (to_lower(c) != 'n' || number) return false;
    number = true;
  }
  return true;
}

/// The line that `at` is in, as bare() has it.
std::string bare_line(std::string_view text, std::size_t at) {
  const std::size_t before = at == 0 ? text.npos : text.rfind('\n', at - 1);
  return bare(text.substr(before == text.npos ? 0 : before + 1));
}

/// `word` with no digit behind it.
bool has_code(std::string_view line, std::string_view word) {
  for (std::size_t at = line.find(word); at != line.npos; at = line.find(word, at + 1)) {
    const std::string_view behind = line.substr(at + word.size(), 1);
    if (behind.empty() || (!is_digit(behind[0]) && behind[0] != '.')) return true;
  }
  return false;
}

/// A torch of QtPlasmaC is spindle 0, a scribe 1, a spotter 2, and each turns at 1: M3 $0 S1.
bool starts_torch(std::string_view line) {
  if (!has_code(line, "m3") && !has_code(line, "m03")) return false;
  return line.find('$') != line.npos || has_code(line, "s1");
}

std::uint32_t lines_before(std::string_view text, std::size_t from, std::size_t at) {
  return static_cast<std::uint32_t>(newline_count(text.substr(from, at - from)));
}

}  // namespace

FilterModes TorchText::modes_at(std::uint32_t line) const {
  const auto after = std::upper_bound(
      changes.begin(), changes.end(), line,
      [](std::uint32_t wanted, const Change& change) { return wanted < change.line; });
  return after == changes.begin() ? FilterModes{} : std::prev(after)->modes;
}

void TorchTextScanner::add(std::string_view text) {
  if (text.find(";qtplasmac filtered") != text.npos) found_.is_filtered = true;
  if (text.find(";conversational block") != text.npos) conversational_ = true;
  for (std::size_t at = text.find("(o="); at != text.npos && !found_.is_qtplasmac;
       at = text.find("(o=", at + 1)) {
    found_.is_qtplasmac = begins_line(text, at);
  }
  look_for_torch(text);
  const std::uint32_t lines_of_earlier = lines_;
  std::size_t counted_to = 0;
  std::uint32_t number = 1;
  for (std::size_t at = text.find("#<"); at != text.npos; at = text.find("#<", at + 1)) {
    const std::string_view name = text.substr(at + 2, 20);
    const bool pin = begins(name, "_hal[");
    if (!pin && !begins_line(text, at)) continue;
    number += lines_before(text, counted_to, at);
    counted_to = at;
    if (pin) {
      if (found_.hal_line == 0) found_.hal_line = lines_of_earlier + number;
      const std::string_view owner = name.substr(5);
      found_.is_qtplasmac |= begins(owner, "plasmac.") || begins(owner, "qtplasmac.");
    } else {
      set_mode(text.substr(at), lines_of_earlier + number);
    }
  }
  lines_ += lines_before(text, 0, text.size());
}

void TorchTextScanner::look_for_torch(std::string_view text) {
  for (const char letter : {'M', 'm'}) {
    for (std::size_t at = text.find(letter); at != text.npos; at = text.find(letter, at + 1)) {
      if (starts_torch_ && changes_material_) return;
      const std::string word = bare(text.substr(at, 12));
      const bool code = word.starts_with("m3") || word.starts_with("m03");
      starts_torch_ = starts_torch_ || (code && starts_torch(bare_line(text, at)));
      changes_material_ = changes_material_ ||
                          (word.starts_with("m190p") && contains(bare_line(text, at), "m190p"));
    }
  }
}

void TorchTextScanner::set_mode(std::string_view line, std::uint32_t number) {
  const std::string code = bare(line);
  const std::size_t close = code.find(">=");
  if (close == code.npos) return;
  const std::string_view name = std::string_view(code).substr(2, close - 2);
  constexpr std::array<std::string_view, 7> kNames = {
      "holes", "h_diameter", "m_diameter", "i_diameter", "h_velocity", "oclength", "pierce-only"};
  const auto known = std::find(kNames.begin(), kNames.end(), name);
  if (known == kNames.end()) return;
  has_modes_ = true;
  double value = 0;
  // The filter reads plain numbers only.
  if (!read_material_number(std::string_view(code).substr(close + 2), value) || value < 0) return;
  switch (known - kNames.begin()) {
    case 0:
      modes_.holes = value >= 1 && value <= 4;
      modes_.arcs = value == 3 || value == 4;
      modes_.overburn = value == 2 || value == 4;
      break;
    case 4:
      modes_.velocity_percent = static_cast<float>(value);
      break;
    case 5:
      modes_.overburn_length = static_cast<float>(value);
      break;
    case 6:
      modes_.pierce_only |= value == 1;  // for the rest of the program
      break;
    default:
      modes_.largest_diameter = static_cast<float>(value);
      break;
  }
  if (found_.changes.size() >= kMaxChanges) return;
  found_.changes.push_back({number, modes_});
}

TorchText TorchTextScanner::take() {
  // None of them alone: a mill's program may have a variable #<holes>, or an M190 of its own.
  found_.is_qtplasmac |= has_modes_ + starts_torch_ + changes_material_ >= 2;
  if (found_.is_filtered || conversational_) found_.changes.clear();
  return std::move(found_);
}

}  // namespace kerf
