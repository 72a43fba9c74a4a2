#include "base/shell_word.h"

#include <algorithm>
#include <string_view>

#include "base/text_scan.h"

namespace kerf {
namespace {

/// What stands for itself in every shell.
bool is_plain(char c) {
  return is_letter(c) || is_digit(c) ||
         std::string_view("_-./:=,+@%").find(c) != std::string_view::npos;
}

}  // namespace

std::string shell_word(const std::string& text) {
  if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain)) return text;
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + "'";
}

}  // namespace kerf
