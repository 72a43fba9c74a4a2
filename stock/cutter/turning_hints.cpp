#include "stock/cutter/turning_hints.h"

#include <optional>
#include <string>

#include "base/text_scan.h"
#include "stock/cutter/tool_number.h"
#include "stock/cutter/turning_shape.h"

namespace kerf {
namespace {

constexpr std::size_t kMostTurningHints = 10000;

/// Nobody writes a designation or a SHAPE of anything else.
bool is_unmistakable(std::string_view shape) {
  return shape.starts_with("iso:") || shape.starts_with("turn:");
}

std::optional<ToolHint> turning_hint(const CommentText& comment,
                                     const std::map<int, TurningFacts>& rows) {
  const std::string_view text = trim(comment.text);
  if (text.empty() || text.size() > kLongestComment) return std::nullopt;
  const std::string lower = to_lower(text);
  int tool = comment.block_tool;
  std::string_view about = text;
  std::optional<NumberedText> numbered = split_tool_number(lower);
  const std::optional<NumberedText> bare = split_bare_number(lower);
  if (bare && tool >= 0 && bare->tool != tool) return std::nullopt;
  if (bare && tool >= 0) numbered = bare;
  if (numbered) {
    tool = numbered->tool;
    about = text.substr(text.size() - numbered->rest.size());
  }
  // What a list begins with counts: "T4: threading tool 60" is not about tool 60.
  const bool is_list = numbered && numbered->separator != ' ';
  const int named = is_list ? -1 : tool_named_in(lower);
  if (named == kSeveralTools || (tool >= 0 && named >= 0 && named != tool)) return std::nullopt;
  const bool is_tools = tool >= 0;
  if (!is_tools) tool = named;
  const auto row = rows.find(tool);
  const std::optional<ShapeText> shape = turning_shape_in_text(
      about, comment.inches, row == rows.end() ? TurningFacts{} : row->second);
  if (!shape || (!is_tools && !is_unmistakable(shape->shape))) return std::nullopt;
  if (tool < 0 && shape->guessed) return std::nullopt;
  ToolHint hint;
  hint.tool = tool;
  hint.line = comment.line;
  hint.dialect = "turning";
  hint.shape = shape->shape;
  hint.shape_guessed = shape->guessed;
  hint.guess = shape->guess;
  hint.near = !comment.at_change && hint.tool < 0;
  return hint;
}

}  // namespace

std::vector<ToolHint> find_turning_hints(std::span<const CommentText> comments,
                                         const std::map<int, TurningFacts>& rows) {
  std::vector<ToolHint> hints;
  for (const CommentText& comment : comments) {
    if (hints.size() == kMostTurningHints) break;
    std::optional<ToolHint> hint = turning_hint(comment, rows);
    if (hint) hints.push_back(std::move(*hint));
  }
  return hints;
}

}  // namespace kerf
