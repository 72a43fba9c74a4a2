#include "interp_bridge/ini_include.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

bool is_name_character(char c) { return is_letter(c) || is_digit(c) || c == '_'; }

/// A byte, and whether a backslash stood before it.
struct ShellByte {
  char byte;
  int column;
  bool escaped;

  bool separates() const { return is_blank(byte) && !escaped; }
};

/// The bytes up to a newline that no backslash joins. Counts the lines.
std::vector<ShellByte> take_bytes(std::string_view& text, ShellLine& line) {
  std::vector<ShellByte> bytes;
  std::size_t at = 0;
  int column = 0;
  line.lines = 1;
  line.raw = text.substr(0, text.find('\n'));
  for (; at < text.size() && !line.complete; ++at) {
    ++column;
    const bool escapes = text[at] == '\\' && at + 1 < text.size();
    if (escapes) ++at, ++column;
    const int shown = line.lines == 1 ? column - (escapes ? 1 : 0) : 0;
    if (text[at] != '\n') {
      if (text[at] != '\\' || escapes) bytes.push_back({text[at], shown, escapes});
    } else if (!escapes) {
      line.complete = true;
    } else if (at + 1 < text.size()) {
      ++line.lines;
    }
  }
  text.remove_prefix(at);
  return bytes;
}

/// `$NAME` or `${NAME}` at `at`, which is left on its last byte.
Result<std::string> variable(std::string_view words, std::size_t& at) {
  const bool braces = at + 1 < words.size() && words[at + 1] == '{';
  const std::size_t start = at + (braces ? 2 : 1);
  std::size_t end = start;
  while (end < words.size() && is_name_character(words[end])) ++end;
  const bool closed = !braces || (end < words.size() && words[end] == '}');
  // Digits and signs name what the script was called with.
  if (end == start || !closed || is_digit(words[start])) {
    return Error{tr("the shell gives '$' a meaning that is not followed here")};
  }
  const char* const value = std::getenv(std::string(words.substr(start, end - start)).c_str());
  at = braces ? end : end - 1;
  return std::string(value == nullptr ? "" : value);
}

}  // namespace

ShellLine take_shell_line(std::string_view& text) {
  ShellLine line;
  const std::vector<ShellByte> bytes = take_bytes(text, line);
  std::size_t at = 0;
  std::size_t end = bytes.size();
  while (at < end && bytes[at].separates()) ++at;
  while (end > at && bytes[end - 1].separates()) --end;
  const auto keep = [&] {
    line.text += bytes[at].byte;
    line.columns.push_back(bytes[at].column);
    ++at;
  };
  while (at < end && !bytes[at].separates()) keep();
  line.word_bytes = line.text.size();
  line.text += ' ';
  line.columns.push_back(at < bytes.size() ? bytes[at].column : 0);
  while (at < end && bytes[at].separates()) ++at;
  while (at < end) keep();
  return line;
}

Result<std::string> shell_file_name(std::string_view words) {
  constexpr std::string_view kShellSigns = "`;|&<>(){}*?[]";
  std::string name;
  char quote = 0;
  bool between = false;  // a blank is owed before the next word
  bool in_word = false;
  for (std::size_t at = 0; at < words.size(); ++at) {
    const char c = words[at];
    if (quote == 0 && is_blank(c)) {
      between = between || in_word;
      in_word = false;
      continue;
    }
    if (quote == 0 && c == '#' && !in_word) break;
    if (between) name += ' ';
    between = false;
    in_word = true;
    const bool backslash = c == '\\' && at + 1 < words.size();
    if (quote != 0 ? c == quote : (c == '"' || c == '\'')) {
      quote = quote != 0 ? '\0' : c;
    } else if (quote == '\'') {
      name += c;
    } else if (c == '$') {
      const Result<std::string> value = variable(words, at);
      if (!value) return value;
      name += *value;
    } else if (backslash &&
               (quote == 0 || std::string_view("$`\"\\").find(words[at + 1]) != words.npos)) {
      name += words[++at];
    } else if (c == '`' || (quote == 0 && kShellSigns.find(c) != kShellSigns.npos)) {
      return Error{trf("the shell gives '{}' a meaning that is not followed here", c)};
    } else {
      name += c;
    }
  }
  if (quote != 0) return Error{trf("the quote {} is not closed", quote)};
  return name;
}

}  // namespace kerf
