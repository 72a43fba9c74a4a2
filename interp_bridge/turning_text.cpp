#include "interp_bridge/turning_text.h"

#include <algorithm>

#include "base/text_scan.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxTools = 1000;
constexpr int kLargest = 99'999;

void set_first(std::uint32_t& line, std::uint32_t now) {
  if (line == 0) line = now;
}

/// Tenths of the number at `at`, which is moved behind it: 7 is 70, 7.1 is 71. -1: none is there.
int read_tenths(std::string_view line, std::size_t& at) {
  std::size_t p = at;
  while (p < line.size() && is_line_blank(line[p])) ++p;
  if (p == line.size() || !is_digit(line[p])) return -1;
  int value = 0;
  for (; p < line.size() && is_digit(line[p]) && value <= kLargest; ++p) {
    value = 10 * value + (line[p] - '0');
  }
  value *= 10;
  if (p + 1 < line.size() && line[p] == '.' && is_digit(line[p + 1])) value += line[p + 1] - '0';
  at = p;
  return value;
}

/// Where the comment or the end of the word that opens at `at` is, past it.
std::size_t skip_enclosed(std::string_view line, std::size_t at, char close) {
  return std::min(line.find(close, at), line.size() - 1) + 1;
}

bool has_q_word(std::string_view line) {
  for (std::size_t at = 0; at < line.size();) {
    const char c = line[at];
    if (c == ';') return false;
    if (c == '(' || c == '<') {
      at = skip_enclosed(line, at, c == '(' ? ')' : '>');
      continue;
    }
    if (to_lower(c) == 'q' && (at == 0 || !is_letter(line[at - 1]))) return true;
    ++at;
  }
  return false;
}

/// Calls with each letter that begins a word and the place behind it, which it may move on.
/// Nothing of lines that begin with `/` or `o`.
template <class Each>
void each_word(std::string_view line, Each&& each) {
  std::size_t at = 0;
  while (at < line.size() && is_line_blank(line[at])) ++at;
  if (at == line.size() || line[at] == '/' || to_lower(line[at]) == 'o') return;
  while (at < line.size()) {
    const char c = to_lower(line[at]);
    if (c == ';') return;
    if (c == '(' || c == '<') {
      at = skip_enclosed(line, at, c == '(' ? ')' : '>');
      continue;
    }
    const bool in_word = at > 0 && is_letter(line[at - 1]);
    ++at;
    if (!in_word) each(c, at);
  }
}

}  // namespace

std::optional<bool> diameter_word(std::string_view line) {
  std::optional<bool> said;
  each_word(line, [&](char c, std::size_t& at) {
    if (c != 'g') return;
    const int tenths = read_tenths(line, at);
    if (tenths == 70 || tenths == 80) said = tenths == 70;
  });
  return said;
}

void TurningScanner::add(std::string_view text) {
  while (!text.empty()) {
    if (line_ >= kMaxLines) {
      words_.whole = false;
      return;
    }
    const std::string_view line = take_line(text);
    ++line_;
    add_line(line);
  }
}

void TurningScanner::add_line(std::string_view line) {
  each_word(line, [&](char c, std::size_t& at) {
    if (c == 'y') words_.moves_y = true;
    if (c != 'g' && c != 't') return;
    const int tenths = read_tenths(line, at);
    if (tenths < 0) return;
    if (c == 'g') {
      note_code(tenths, has_q_word(line));
    } else if (tenths > 0 && words_.tools.size() < kMaxTools) {
      words_.tools.insert(tenths / 10);
    }
  });
}

void TurningScanner::note_code(int tenths, bool has_q) {
  switch (tenths) {
    case 70:
      return set_first(words_.diameter_mode, line_);
    case 80:
      return set_first(words_.radius_mode, line_);
    case 170:
    case 190:
      words_.other_plane = true;
      return;
    case 180:
      return set_first(words_.plane_xz, line_);
    case 330:
      if (words_.plane_xz != 0) set_first(words_.thread, line_);
      return;
    case 410:
    case 411:
    case 420:
    case 421:
      if (words_.plane_xz != 0) set_first(words_.compensation, line_);
      return;
    case 760:
      if (words_.plane_xz != 0) set_first(words_.threading, line_);
      return;
    case 950:
      return set_first(words_.feed_per_turn, line_);
    case 960:
      return set_first(words_.surface_speed, line_);
    default:
      if (tenths >= 700 && tenths < 730 && tenths % 10 < 3 && has_q) {
        set_first(words_.contour_cycle, line_);
      }
  }
}

}  // namespace kerf
