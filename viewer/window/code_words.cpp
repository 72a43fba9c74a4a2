#include "viewer/window/code_words.h"

#include <algorithm>

#include "base/text_scan.h"

namespace kerf {
namespace {

CodeKind kind_of_letter(char letter) {
  switch (to_lower(letter)) {
    case 'g':
      return CodeKind::kMotion;
    case 'm':
    case 's':
    case 't':
      return CodeKind::kMachine;
    case 'f':
      return CodeKind::kFeed;
    case 'n':
      return CodeKind::kNumber;
    case 'o':
      return CodeKind::kControl;
    default:
      return CodeKind::kPlace;
  }
}

/// Where the value of a word ends that begins at `at`: a number, a parameter, or [ .. ].
std::size_t value_end(std::string_view line, std::size_t at) {
  while (at < line.size() && is_blank(line[at])) ++at;
  int depth = 0;
  for (; at < line.size(); ++at) {
    const char c = line[at];
    if (c == '[' || c == '<') ++depth;
    if (depth == 0 && (is_letter(c) || is_blank(c) || c == '(' || c == ';' || c == '=')) break;
    if (depth > 0 && (c == ';' || c == '(')) break;
    if (c == ']' || c == '>') --depth;
  }
  return at;
}

/// The end of the word that begins at `at`, and its kind.
CodeWord word_at(std::string_view line, std::size_t at) {
  const char c = line[at];
  if (c == ';') return {at, line.size() - at, CodeKind::kComment};
  if (c == '(') {
    const std::size_t close = line.find(')', at);
    return {at, (close == std::string_view::npos ? line.size() : close + 1) - at,
            CodeKind::kComment};
  }
  // What a parameter is called and set to.
  if (c == '#') return {at, value_end(line, at + 1) - at, CodeKind::kControl};
  const bool is_bracket = c == '[' || c == '<';
  if (!is_letter(c)) return {at, value_end(line, at + (is_bracket ? 0 : 1)) - at, CodeKind::kOther};
  std::size_t letters = at;
  while (letters < line.size() && is_letter(line[letters])) ++letters;
  // if, endwhile, call: what stands behind an O word.
  if (letters - at > 1 && (at == 0 || !is_digit(line[at - 1]))) {
    return {at, letters - at, CodeKind::kControl};
  }
  return {at, value_end(line, at + 1) - at, kind_of_letter(c)};
}

}  // namespace

std::vector<CodeWord> code_words(std::string_view line) {
  std::vector<CodeWord> words;
  for (std::size_t at = 0; at < line.size();) {
    if (is_blank(line[at])) {
      std::size_t end = at;
      while (end < line.size() && is_blank(line[end])) ++end;
      if (words.empty()) {
        words.push_back({at, end - at, CodeKind::kOther});
      } else {
        words.back().length += end - at;
      }
      at = end;
      continue;
    }
    words.push_back(word_at(line, at));
    at += words.back().length;
  }
  return words;
}

std::size_t find_text(std::string_view line, std::string_view wanted) {
  if (wanted.empty()) return std::string_view::npos;
  const auto found = std::search(line.begin(), line.end(), wanted.begin(), wanted.end(),
                                 [](char a, char b) { return to_lower(a) == to_lower(b); });
  if (found == line.end()) return std::string_view::npos;
  return static_cast<std::size_t>(found - line.begin());
}

}  // namespace kerf
