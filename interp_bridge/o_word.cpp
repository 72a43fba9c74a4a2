#include "interp_bridge/o_word.h"

#include "base/text_scan.h"

namespace kerf {
namespace {

/// A line without blanks and without comments.
std::string without_comments(std::string_view line) {
  std::string out;
  bool in_comment = false;
  for (const char c : line) {
    if (c == ';' && !in_comment) break;
    if (c == '(') in_comment = true;
    if (!in_comment && !is_line_blank(c) && c != '\r') out += c;
    if (c == ')') in_comment = false;
  }
  return out;
}

std::string_view digits_at(std::string_view text, std::size_t at) {
  const std::size_t end = text.find_first_not_of("0123456789", at);
  return text.substr(at, end == text.npos ? text.npos : end - at);
}

std::optional<OWord::Kind> kind_of(std::string_view word) {
  if (word.starts_with("call")) return OWord::Kind::kCall;
  if (word.starts_with("sub")) return OWord::Kind::kSub;
  if (word.starts_with("endsub")) return OWord::Kind::kEndSub;
  return std::nullopt;
}

std::optional<OWord> called_by_m98(std::string_view small) {
  const std::size_t word = small.find("m98"), at = small.find('p');
  if (word == small.npos || at == small.npos) return std::nullopt;
  if (!digits_at(small, word + 3).empty()) return std::nullopt;  // M980 is another one
  const std::string_view number = digits_at(small, at + 1);
  if (number.empty()) return std::nullopt;
  return OWord{OWord::Kind::kCall, std::string(number)};
}

}  // namespace

std::optional<OWord> o_word(std::string_view line) {
  // Most lines have neither, which a look at their bytes tells.
  if (line.find_first_of("oO") == line.npos && line.find("98") == line.npos) return std::nullopt;
  const std::string plain = without_comments(line), small = to_lower(plain);
  // Behind '/' and the block number, an O word comes first.
  std::size_t at = small.starts_with('/') ? 1 : 0;
  if (at < small.size() && small[at] == 'n') at += 1 + digits_at(small, at + 1).size();
  if (at >= small.size() || small[at] != 'o') return called_by_m98(small);
  ++at;
  const bool is_named = at < small.size() && small[at] == '<';
  const std::size_t begin = is_named ? at + 1 : at;
  const std::size_t end =
      is_named ? small.find('>', begin) : begin + digits_at(small, begin).size();
  if (end == small.npos || end == begin) return std::nullopt;
  const std::optional<OWord::Kind> kind =
      kind_of(std::string_view(small).substr(is_named ? end + 1 : end));
  if (!kind) return std::nullopt;
  return OWord{*kind, plain.substr(begin, end - begin)};
}

}  // namespace kerf
