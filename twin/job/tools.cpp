#include "twin/job/tools.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/job/turning_row.h"

namespace kerf {
namespace {

/// Decimals of one and the same cutter differ by less: 12.7 and 1/2", 4.76 and 3/16".
constexpr double kSameDiameter = 0.02;

std::string_view kind_of(std::string_view shape) { return shape.substr(0, shape.find(':')); }

/// What the interpreter compensates by.
KnownDiameter compensation_of(const Cutter& cutter, bool by_argument) {
  return {table_diameter_mm(cutter), by_argument, cutter.insert_tip().orientation};
}

/// Two descriptions that cannot be of one cutter. Corners and points are often left out.
bool disagree(const ToolHint& a, const ToolHint& b) {
  const Result<Cutter> one = parse_shape(a.shape);
  const Result<Cutter> other = parse_shape(b.shape);
  if (!one || !other) return false;
  const double larger = std::max(one->radius_mm(), other->radius_mm());
  if (std::abs(one->radius_mm() - other->radius_mm()) > kSameDiameter * larger) return true;
  if (a.shape_guessed || b.shape_guessed) return false;
  const auto plain = [](const ToolHint& hint) {
    return kind_of(hint.shape) == "bull" ? std::string_view("flat") : kind_of(hint.shape);
  };
  return plain(a) != plain(b);
}

}  // namespace

std::vector<ToolHint> hints_in_force(const ToolSources& sources) {
  if (!sources.turning) return sources.hints;
  std::vector<ToolHint> hints = sources.turning_hints;
  for (const ToolHint& hint : sources.hints) {
    const auto about_it = [&](const ToolHint& turning) {
      return turning.line == hint.line || (hint.tool >= 0 && turning.tool == hint.tool);
    };
    if (std::none_of(sources.turning_hints.begin(), sources.turning_hints.end(), about_it)) {
      hints.push_back(hint);
    }
  }
  return hints;
}

std::map<int, KnownDiameter> known_diameters(const ToolSources& sources) {
  std::map<int, KnownDiameter> known;
  for (const ToolShapeArgument& argument : sources.arguments) {
    known[argument.tool] = compensation_of(argument.cutter, true);
  }
  for (const LibraryTool& tool : sources.library) {
    if (tool.cutter) known.try_emplace(*tool.number, compensation_of(*tool.cutter, false));
  }
  // Whole shapes before those of which only the diameter is known, as ToolResolver has it.
  const std::vector<ToolHint> hints = hints_in_force(sources);
  for (const bool guessed : {false, true}) {
    for (const ToolHint& hint : hints) {
      if (hint.tool <= 0 || hint.shape_guessed != guessed || known.count(hint.tool) != 0) continue;
      if (const Result<Cutter> cutter = parse_shape(hint.shape)) {
        known[hint.tool] = compensation_of(*cutter, false);
      }
    }
  }
  return known;
}

KnownTools known_tools(const ToolSources& sources) {
  return {known_diameters(sources), sources.turning};
}

ToolResolver::ToolResolver(ToolSources sources, CutterCheck can_cut)
    : sources_(std::move(sources)), can_cut_(can_cut) {
  sources_.hints = hints_in_force(sources_);
  std::stable_sort(sources_.hints.begin(), sources_.hints.end(),
                   [](const ToolHint& a, const ToolHint& b) { return a.line < b.line; });
}

const ResolvedTool& ToolResolver::mount(int tool, std::uint32_t line) {
  const std::optional<std::size_t> fresh_hint = take_nameless_hint(line);
  const auto known = tools_.find(tool);
  if (known != tools_.end() && known->second.cutter) return known->second;
  ResolvedTool resolved = tool == 0 ? resolve_empty_spindle(fresh_hint) : resolve(tool, fresh_hint);
  drill_where_it_drills(resolved, tool);
  refuse_unfit(resolved);
  return tools_[tool] = std::move(resolved);
}

/// The last comment without a tool number between the previous tool's first move and this one's;
/// running text only if there is no other.
std::optional<std::size_t> ToolResolver::take_nameless_hint(std::uint32_t line) {
  std::optional<std::size_t> found;
  while (next_hint_ < sources_.hints.size() && sources_.hints[next_hint_].line <= line) {
    const ToolHint& hint = sources_.hints[next_hint_];
    if (hint.tool < 0 && !(found && !sources_.hints[*found].near && hint.near)) found = next_hint_;
    ++next_hint_;
  }
  return found;
}

bool ToolResolver::from_argument(ResolvedTool& out) const {
  for (const ToolShapeArgument& argument : sources_.arguments) {
    if (argument.tool != out.number) continue;
    out.cutter = argument.cutter;
    out.origin = "--tool";
    return true;
  }
  return false;
}

bool ToolResolver::from_library(ResolvedTool& out) const {
  for (const LibraryTool& tool : sources_.library) {
    if (tool.number != out.number) continue;
    if (!tool.cutter) {
      out.trouble = trf("tool library {}: {}", tool.path, tool.trouble);
      return false;
    }
    out.cutter = tool.cutter;
    out.origin = tool.name.empty() ? trf("tool library {}", tool.path)
                                   : trf("tool library {}: {}", tool.path, shown(tool.name));
    return true;
  }
  return false;
}

bool ToolResolver::from_hint(ResolvedTool& out, const ToolHint& hint) const {
  Result<Cutter> cutter = parse_shape(hint.shape);
  if (!cutter) {
    out.trouble = trf("the comment in line {} ({}) gives no usable shape: {}", hint.line,
                      hint.dialect, cutter.error());
    return false;
  }
  out.cutter = std::move(cutter.value());
  out.origin = trf("comment in line {} ({})", hint.line, hint.dialect);
  out.guessed = hint.shape_guessed || hint.near;
  out.guess = hint.near ? tr("that comment names no tool, and may be about another") : hint.guess;
  return true;
}

/// Those that name the tool. Whole shapes win over those with a diameter only; else the first one
/// counts.
bool ToolResolver::from_comments(ResolvedTool& out) const {
  return from_comments(out, false) || from_comments(out, true);
}

bool ToolResolver::from_comments(ResolvedTool& out, bool guessed) const {
  for (const ToolHint& hint : sources_.hints) {
    if (hint.tool != out.number || hint.shape_guessed != guessed || !from_hint(out, hint)) continue;
    note_disagreement(out, hint);
    return true;
  }
  return false;
}

void ToolResolver::note_disagreement(ResolvedTool& out, const ToolHint& taken) const {
  for (const ToolHint& other : sources_.hints) {
    if (other.tool != taken.tool || !disagree(taken, other)) continue;
    out.guessed = true;
    out.guess = trf("the comment in line {} describes it as {}", other.line, other.shape);
    return;
  }
}

/// The one that stands where the tool is changed, `near` or not.
bool ToolResolver::from_place(ResolvedTool& out, std::optional<std::size_t> fresh_hint,
                              bool near) const {
  return fresh_hint && sources_.hints[*fresh_hint].near == near &&
         from_hint(out, sources_.hints[*fresh_hint]);
}

bool ToolResolver::from_table(ResolvedTool& out) const {
  for (const ToolTableRow& row : sources_.table) {
    if (row.tool != out.number) continue;
    if (sources_.turning) return from_turning_row(out, row);
    if (!(row.diameter_mm > 0)) {
      out.trouble = trf("the tool table (line {}) gives no diameter for it", row.line);
      return false;
    }
    if (const auto hint = shape_from_remark(row.tool, row.diameter_mm, row.remark)) {
      if (from_hint(out, *hint)) {
        out.origin = trf("remark in line {} of the tool table", row.line);
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
    out.origin = trf("diameter in line {} of the tool table", row.line);
    return true;
  }
  return false;
}

bool ToolResolver::from_turning_row(ResolvedTool& out, const ToolTableRow& row) const {
  const auto take = [&](const ShapeText& text) {
    Result<Cutter> cutter = parse_shape(text.shape);
    if (!cutter) {
      out.trouble = trf("line {} of the tool table: {}", row.line, cutter.error());
      return false;
    }
    out.cutter = std::move(cutter.value());
    out.guessed = text.guessed;
    out.guess = text.guess;
    return true;
  };
  if (const std::optional<ShapeText> remark = turning_remark_shape(row)) {
    out.origin = trf("remark in line {} of the tool table", row.line);
    return take(*remark);
  }
  const bool drills =
      std::any_of(sources_.guesses.begin(), sources_.guesses.end(), [&](const ToolGuess& guess) {
        return guess.tool == row.tool && guess.of_known_size && kind_of(guess.shape) == "drill";
      });
  out.origin = trf("line {} of the tool table", row.line);
  return take(turning_row_shape(row, drills));
}

bool ResolvedTool::is_size_alone() const {
  return cutter && guessed && guess.empty() && !from_moves &&
         kind_of(cutter->spec()) == std::string_view("flat");
}

/// `tool`: what the program calls it.
void ToolResolver::drill_where_it_drills(ResolvedTool& out, int tool) const {
  if (!out.is_size_alone()) return;
  for (const ToolGuess& guess : sources_.guesses) {
    if (guess.tool != tool || !guess.of_known_size) continue;
    Result<Cutter> cutter = parse_shape(guess.shape);
    // The same tool may have had another comment where it came first.
    if (!cutter || cutter->radius_mm() != out.cutter->radius_mm()) continue;
    out.cutter = std::move(cutter.value());
    out.guess = guess.reason;
    return;
  }
}

bool ToolResolver::from_guess(ResolvedTool& out) const {
  for (const ToolGuess& guess : sources_.guesses) {
    if (guess.tool != out.number || guess.of_known_size) continue;
    Result<Cutter> cutter = parse_shape(guess.shape);
    if (!cutter) return false;
    out.cutter = std::move(cutter.value());
    out.guessed = out.from_moves = true;
    out.assumed = false;
    out.origin = tr("its moves");
    out.guess = guess.reason;
    out.trouble.clear();
    return true;
  }
  return false;
}

ResolvedTool ToolResolver::resolve(int tool, std::optional<std::size_t> fresh_hint) const {
  ResolvedTool out;
  out.number = tool;
  // On a lathe a comment that has no more than a diameter says less than the table.
  const bool told = from_argument(out) || from_library(out) ||
                    (sources_.turning && (from_comments(out, false) || from_table(out)));
  if (told || from_comments(out) || from_place(out, fresh_hint, false) || from_table(out) ||
      from_place(out, fresh_hint, true) || from_guess(out)) {
    out.trouble.clear();
  }
  return out;
}

ResolvedTool ToolResolver::resolve_empty_spindle(std::optional<std::size_t> fresh_hint) const {
  ResolvedTool out;
  out.assumed = true;
  if (!sources_.arguments.empty()) {
    if (sources_.arguments.size() == 1) {
      out.number = sources_.arguments[0].tool;
      from_argument(out);
    }
  } else if (!from_place(out, fresh_hint, false) && !from_only_tool(out)) {
    from_place(out, fresh_hint, true);
  }
  if (!out.cutter) {
    out.number = 0;
    from_guess(out);
  }
  return out;
}

/// All comments that name a tool name the same one.
bool ToolResolver::from_only_tool(ResolvedTool& out) const {
  int only = -1;
  for (const ToolHint& hint : sources_.hints) {
    if (hint.tool < 0 && hint.near) continue;
    if (hint.tool < 0 || (only >= 0 && hint.tool != only)) return false;
    only = hint.tool;
  }
  if (only < 0) return false;
  out.number = only;
  return from_comments(out);
}

void ToolResolver::refuse_unfit(ResolvedTool& tool) const {
  if (!tool.cutter) return;
  if (tool.cutter->insert() != nullptr && !sources_.turning) {
    tool.trouble =
        trf("{} is a turning tool, which stands still; here the tools turn", tool.cutter->spec());
    tool.cutter.reset();
    return;
  }
  if (can_cut_ == nullptr) return;
  const Done fit = can_cut_(*tool.cutter);
  if (fit) return;
  tool.trouble = fit.error();
  tool.cutter.reset();
}

}  // namespace kerf
