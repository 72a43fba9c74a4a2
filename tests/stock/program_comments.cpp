#include "tests/stock/program_comments.h"

#include <optional>

#include "base/text_scan.h"

namespace kerf {
namespace {

/// G20 or G21 at `at`: whether it is inches.
std::optional<bool> units_word(std::string_view line, std::size_t at) {
  const std::string_view word = line.substr(at, 3);
  const bool longer = at + 3 < line.size() && line[at + 3] >= '0' && line[at + 3] <= '9';
  if (longer) return std::nullopt;
  if (word == "g20") return true;
  if (word == "g21") return false;
  return std::nullopt;
}

}  // namespace

std::vector<CommentText> comments_of(std::string_view program) {
  std::vector<CommentText> comments;
  std::optional<bool> inches;
  std::uint32_t number = 0;
  for (const std::string_view line : split(program, '\n')) {
    ++number;
    const std::string lower = to_lower(line);
    for (std::size_t at = 0; at < line.size(); ++at) {
      const char c = line[at];
      if (c == '(' || c == ';') {
        const std::size_t end = c == ';' ? std::string_view::npos : line.find(')', at);
        const std::string_view text =
            line.substr(at + 1, end == std::string_view::npos ? end : end - at - 1);
        comments.push_back({number, std::string(text), inches.value_or(false)});
        if (end == std::string_view::npos) break;
        at = end;
      } else if (const std::optional<bool> units = units_word(lower, at)) {
        if (!inches) {
          for (CommentText& comment : comments) comment.inches = *units;
        }
        inches = units;
      }
    }
  }
  return comments;
}

}  // namespace kerf
