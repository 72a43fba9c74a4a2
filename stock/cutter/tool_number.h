// stock/cutter/tool_number.h - which tool a comment is about: "T12 ...", "TOOL: T1 = ...".
#pragma once

#include <optional>
#include <string_view>

namespace kerf {

/// Interpreters refuse lines of half this length; what is longer is not a tool.
inline constexpr std::size_t kLongestComment = 512;

std::string_view without_leading(std::string_view text, std::string_view characters);

/// Digits at the start; moves `text` behind them.
std::optional<int> take_integer(std::string_view& text);

/// "T12 rest", "T01 = rest", "TOOL: T1 = rest", "Tool 3: rest". After the bare word "tool" the
/// number needs a separator, or it is a size ("Tool: 1/4 in end mill").
struct NumberedText {
  int tool = 0;
  char separator = ' ';  ///< ':', '=', '|', '-' or ' '
  std::string_view rest;
};
/// Of lower-case text.
std::optional<NumberedText> split_tool_number(std::string_view lower);

/// "Tool: 23 YG-1 .375 stub drill": a whole number behind the bare word, that neither a unit nor a
/// fraction nor "flute" or "V-bit" makes one of the tool's own. The separator is ' '.
/// Of lower-case text.
std::optional<NumberedText> split_bare_number(std::string_view lower);

/// Tools that a text names: "t05", "tool 5", "tool no. 5", "tool #5". Of none: -1; of several:
/// kSeveralTools.
constexpr int kSeveralTools = -2;
int tool_named_in(std::string_view lower);

}  // namespace kerf
