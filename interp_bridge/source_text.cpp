#include "interp_bridge/source_text.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/newline_count.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "interp_bridge/canonical.h"

namespace kerf {
namespace {

constexpr std::size_t kPieceBytes = 256 * 1024;
constexpr std::size_t kExcerptBytes = 200;
constexpr std::size_t kHeaderLines = 2000;
constexpr std::size_t kMaxLaterComments = 1000;

/// A tool table with rows that rs274 rejects prints a few foreign lines before the first canonical
/// one.
constexpr std::size_t kLinesToTellListing = 40;

/// Form feeds, too: old listings have them between pages.
bool is_page_blank(char c) { return is_text_blank(c) || c == '\f'; }

bool contains_word(std::string_view text, std::string_view lower_case_word) {
  const auto found =
      std::search(text.begin(), text.end(), lower_case_word.begin(), lower_case_word.end(),
                  [](char a, char b) { return to_lower(a) == b; });
  return found != text.end();
}

/// M6 or M06 of the code, as posts write it.
bool changes_tool(std::string_view line) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    if (to_lower(line[i]) != 'm') continue;
    std::size_t digit = i + 1;
    if (line[digit] == '0' && digit + 1 < line.size()) ++digit;
    const bool ends = digit + 1 >= line.size() || !is_digit(line[digit + 1]);
    if (line[digit] == '6' && ends) return true;
  }
  return false;
}

bool is_hint(std::string_view comment) {
  constexpr std::array<std::string_view, 3> kWords = {"tool", "stock", "workpiece"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [&](std::string_view word) { return contains_word(comment, word); });
}

}  // namespace

TextPieces::TextPieces(const std::string& path)
    : path_(path), fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (fd_ < 0)
    error_ = trf("cannot read {}: {}", path, std::strerror(errno));
  else
    buffer_.resize(kPieceBytes);
}

TextPieces::~TextPieces() {
  if (fd_ >= 0) close(fd_);
}

void TextPieces::fill() {
  while (!at_end_ && filled_ < buffer_.size()) {
    const ssize_t got = read(fd_, buffer_.data() + filled_, buffer_.size() - filled_);
    if (got > 0) {
      filled_ += static_cast<std::size_t>(got);
    } else if (got == 0) {
      at_end_ = true;
    } else if (errno != EINTR) {
      error_ = trf("cannot read {}: {}", path_, std::strerror(errno));
      at_end_ = true;
    }
  }
}

bool TextPieces::next(std::string_view& piece) {
  if (fd_ < 0) return false;
  std::memmove(buffer_.data(), buffer_.data() + given_, filled_ - given_);
  filled_ -= given_;
  given_ = 0;
  fill();
  if (!error_.empty() || filled_ == 0) return false;
  given_ = filled_;
  if (!at_end_) {
    const std::size_t newline = std::string_view(buffer_.data(), filled_).rfind('\n');
    if (newline != std::string_view::npos) given_ = newline + 1;
  }
  piece = {buffer_.data(), given_};
  return true;
}

std::string line_of_file(const std::string& path, std::uint32_t line) {
  TextPieces pieces(path);
  std::string_view piece;
  std::size_t before = 0;  // lines in earlier pieces
  while (line > 0 && pieces.next(piece)) {
    const auto here = static_cast<std::size_t>(std::count(piece.begin(), piece.end(), '\n'));
    if (before + here < line && !piece.empty() && piece.back() == '\n') {
      before += here;
      continue;
    }
    for (; before + 1 < line && !piece.empty(); ++before) take_line(piece);
    std::string_view text = take_line(piece).substr(0, kExcerptBytes);
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return std::string(text);
  }
  return {};
}

void TextSurveyor::add(std::string_view text) {
  if (survey_.nul_line == 0) {
    if (const auto nul = text.find('\0'); nul != text.npos) {
      const auto end = text.begin() + static_cast<std::ptrdiff_t>(nul);
      survey_.nul_line =
          survey_.lines + static_cast<std::size_t>(std::count(text.begin(), end, '\n')) + 1;
    }
  }
  survey_.bytes += text.size();
  if (survey_.blank) survey_.blank = trim(text, is_page_blank).empty();
  if (nonblank_lines_ < kLinesToTellListing && !survey_.listing) decide_kind(text);
  add_lines(text);
  if (survey_.listing) return;
  torch_.add(text);
  turning_.add(text);
}

TextSurvey TextSurveyor::take() {
  survey_.torch = torch_.take();
  survey_.turning = turning_.take();
  return std::move(survey_);
}

void TextSurveyor::decide_kind(std::string_view text) {
  while (!text.empty() && nonblank_lines_ < kLinesToTellListing && !survey_.listing) {
    const std::string_view line = take_line(text);
    if (!trim(line, is_page_blank).empty()) {
      ++nonblank_lines_;
      survey_.listing = looks_canonical(line);
    }
  }
}

void TextSurveyor::add_lines(std::string_view text) {
  while (!text.empty() && survey_.lines < kHeaderLines) {
    const std::string_view line = take_line(text);
    ++survey_.lines;
    add_comments(line, static_cast<std::uint32_t>(survey_.lines), false);
  }
  if (text.empty()) return;
  if (!survey_.listing) add_later_lines(text);
  survey_.lines += newline_count(text);
  if (text.back() != '\n') ++survey_.lines;
}

/// Goes from comment to comment, not from line to line: most of a long program has none.
void TextSurveyor::add_later_lines(std::string_view text) {
  std::size_t counted_to = 0;
  std::size_t number = survey_.lines + 1;
  std::size_t paren = text.find('(');
  std::size_t semicolon = text.find(';');
  while (later_comments_ < kMaxLaterComments) {
    const std::size_t at = std::min(paren, semicolon);
    if (at == text.npos) return;
    const std::size_t before = at == 0 ? text.npos : text.rfind('\n', at - 1);
    const std::size_t begin = before == text.npos ? 0 : before + 1;
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const auto from = text.begin() + static_cast<std::ptrdiff_t>(counted_to);
    const auto to = text.begin() + static_cast<std::ptrdiff_t>(begin);
    number += static_cast<std::size_t>(std::count(from, to, '\n'));
    counted_to = begin;
    const std::string_view line = text.substr(begin, end - begin);
    const std::size_t count = survey_.comments.size();
    add_comments(line, static_cast<std::uint32_t>(number), !changes_tool(line));
    later_comments_ += survey_.comments.size() - count;
    if (paren < end) paren = text.find('(', end);
    if (semicolon < end) semicolon = text.find(';', end);
  }
}

void TextSurveyor::add_comments(std::string_view line, std::uint32_t number, bool only_hints) {
  const auto keep = [&](std::string_view comment) {
    comment = trim(comment, is_page_blank);
    if (comment.empty() || (only_hints && !is_hint(comment))) return;
    survey_.comments.push_back({{0, number}, std::string(comment)});
  };
  if (survey_.listing) {
    CanonicalLine parsed;
    parse_canonical_line(line, parsed);
    // What rs274 says of itself is not the program's.
    const bool own = parsed.command.text.substr(0, 12) != "interpreter:";
    if (parsed.kind == CanonicalLineKind::kCommand &&
        parsed.command.name == CanonicalName::kComment && own) {
      keep(parsed.command.text);
    }
    return;
  }
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == ';') return keep(line.substr(i + 1));
    if (line[i] != '(') continue;
    const std::size_t close = std::min(line.find(')', i), line.size());
    keep(line.substr(i + 1, close - i - 1));
    i = close;
  }
}

}  // namespace kerf
