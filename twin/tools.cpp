#include "twin/tools.h"

#include <fmt/format.h>

#include <algorithm>

namespace kerf {

ToolBook::ToolBook(ToolSources sources, CutterCheck can_cut)
    : sources_(std::move(sources)), can_cut_(can_cut) {
  std::stable_sort(sources_.hints.begin(), sources_.hints.end(),
                   [](const ToolHint& a, const ToolHint& b) { return a.line < b.line; });
}

const ResolvedTool& ToolBook::mount(int tool, std::uint32_t line) {
  const std::optional<std::size_t> fresh_hint = take_nameless_hint(line);
  const auto known = tools_.find(tool);
  if (known != tools_.end() && known->second.cutter) return known->second;
  ResolvedTool resolved = tool == 0 ? resolve_empty_spindle(fresh_hint) : resolve(tool, fresh_hint);
  refuse_unfit(resolved);
  return tools_[tool] = std::move(resolved);
}

/// The last comment without a tool number between the previous tool's first move and this one's.
std::optional<std::size_t> ToolBook::take_nameless_hint(std::uint32_t line) {
  std::optional<std::size_t> found;
  while (next_hint_ < sources_.hints.size() && sources_.hints[next_hint_].line <= line) {
    if (sources_.hints[next_hint_].tool < 0) found = next_hint_;
    ++next_hint_;
  }
  return found;
}

bool ToolBook::from_argument(ResolvedTool& out) const {
  for (const ToolShapeArgument& argument : sources_.arguments) {
    if (argument.tool != out.number) continue;
    out.cutter = argument.cutter;
    out.origin = "--tool";
    return true;
  }
  return false;
}

bool ToolBook::from_hint(ResolvedTool& out, const ToolHint& hint) const {
  Result<Cutter> cutter = parse_shape(hint.shape);
  if (!cutter) {
    out.trouble = fmt::format("the comment in line {} ({}) gives no usable shape: {}", hint.line,
                              hint.dialect, cutter.error());
    return false;
  }
  out.cutter = std::move(cutter.value());
  out.origin = fmt::format("comment in line {} ({})", hint.line, hint.dialect);
  out.guessed = hint.shape_guessed;
  return true;
}

/// Comments that give a whole shape win over those with a diameter only; else the first one counts.
bool ToolBook::from_comments(ResolvedTool& out, std::optional<std::size_t> fresh_hint) const {
  for (const bool guessed : {false, true}) {
    for (const ToolHint& hint : sources_.hints) {
      if (hint.tool == out.number && hint.shape_guessed == guessed && from_hint(out, hint)) {
        return true;
      }
    }
  }
  return fresh_hint && from_hint(out, sources_.hints[*fresh_hint]);
}

bool ToolBook::from_table(ResolvedTool& out) const {
  for (const ToolTableRow& row : sources_.table) {
    if (row.tool != out.number) continue;
    if (!(row.diameter_mm > 0)) {
      out.trouble = fmt::format("the tool table (line {}) gives no diameter for it", row.line);
      return false;
    }
    if (const auto hint = shape_from_remark(row.tool, row.diameter_mm, row.remark)) {
      if (from_hint(out, *hint)) {
        out.origin = fmt::format("remark in line {} of the tool table", row.line);
        return true;
      }
    }
    Result<Cutter> flat = parse_shape(fmt::format("flat:{:g}", row.diameter_mm));
    if (!flat) {
      out.trouble = flat.error();
      return false;
    }
    out.cutter = std::move(flat.value());
    out.guessed = true;
    out.origin = fmt::format("diameter in line {} of the tool table", row.line);
    return true;
  }
  return false;
}

ResolvedTool ToolBook::resolve(int tool, std::optional<std::size_t> fresh_hint) const {
  ResolvedTool out;
  out.number = tool;
  if (from_argument(out) || from_comments(out, fresh_hint) || from_table(out)) {
    out.trouble.clear();
  }
  return out;
}

ResolvedTool ToolBook::resolve_empty_spindle(std::optional<std::size_t> fresh_hint) const {
  ResolvedTool out;
  out.assumed = true;
  if (!sources_.arguments.empty()) {
    if (sources_.arguments.size() == 1) {
      out.number = sources_.arguments[0].tool;
      from_argument(out);
    }
    return out;
  }
  if (fresh_hint) {
    from_hint(out, sources_.hints[*fresh_hint]);
    return out;
  }
  const std::vector<ToolHint>& hints = sources_.hints;
  const bool alone =
      !hints.empty() && std::all_of(hints.begin(), hints.end(), [&](const ToolHint& h) {
        return h.tool >= 0 && h.tool == hints[0].tool;
      });
  if (alone) {
    out.number = hints[0].tool;
    from_comments(out, std::nullopt);
  }
  return out;
}

void ToolBook::refuse_unfit(ResolvedTool& tool) const {
  if (!tool.cutter || can_cut_ == nullptr) return;
  const Done fit = can_cut_(*tool.cutter);
  if (fit) return;
  tool.trouble = fit.error();
  tool.cutter.reset();
}

}  // namespace kerf
