#include "twin/process/tool_tells.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "base/translate.h"
#include "twin/job/tool_number.h"
#include "twin/process/finding_at.h"

namespace kerf {

ToolUse use_of(const ResolvedTool& tool) {
  ToolUse use;
  use.number = tool.number;
  if (tool.cutter) use.origin = tool.origin;
  use.guessed = tool.guessed;
  if (tool.cutter) {
    use.shape = tool.cutter->spec();
    use.teeth = tool.cutter->teeth();
  }
  return use;
}

void tell_tool(const ResolvedTool& tool, const Motion& m, FindingLog& log) {
  if (!tool.cutter) return;
  const std::string& shape = tool.cutter->spec();
  Finding finding;
  finding.source = m.source;
  finding.tool = tool.number;
  if (tool.assumed) {
    finding.id = FindingId::kToolAssumed;
    finding.severity = Severity::kNote;
    finding.text = trf(
        "the program moves before any tool change; tool {} ({}, {}) is taken to be in the spindle",
        tool.number, shape, tool.origin);
    log.add(finding);
  }
  if (tool.guessed) {
    finding.id = FindingId::kToolGuessed;
    finding.severity = Severity::kWarning;
    finding.text =
        tool.from_moves
            ? trf("nothing is known of {}; by its moves it is taken for {}, and that is a "
                  "guess: {} (--tool {}=SHAPE says better)",
                  tool.number == 0 ? std::string(tr("the tool in the spindle"))
                                   : trf("tool {}", tool.number),
                  shape, tool.guess, std::max(1, tool.number))
        : tool.guess.empty()
            ? trf("only the diameter of tool {} is known ({}); a flat cutter is assumed: {} "
                  "(--tool "
                  "{}=SHAPE says better)",
                  tool.number, tool.origin, shape, std::max(1, tool.number))
            : trf("tool {} is taken for {} ({}), and that is a guess: {} (--tool {}=SHAPE "
                  "says better)",
                  tool.number, shape, tool.origin, tool.guess, std::max(1, tool.number));
    if (tool.from_moves) finding.hint = hint_of_number(tool.number);
    log.add(finding);
  }
}

std::size_t place_of_use(std::vector<ToolUse>& uses, const ResolvedTool& tool, const Motion& m,
                         FindingLog& log) {
  ToolUse fresh = use_of(tool);
  auto known = std::find_if(uses.begin(), uses.end(), [&](const ToolUse& use) {
    return use.number == fresh.number && use.shape == fresh.shape;
  });
  if (known == uses.end()) {
    known = std::find_if(uses.begin(), uses.end(), [&](const ToolUse& use) {
      return use.number == fresh.number && use.shape.empty();
    });
    known = known == uses.end() ? uses.insert(uses.end(), std::move(fresh))
                                : uses.insert(uses.erase(known), std::move(fresh));
    tell_tool(tool, m, log);
  }
  return static_cast<std::size_t>(known - uses.begin());
}

void tell_undefined(const ResolvedTool& tool, const Motion& m, const TimedStep& step,
                    FindingLog& log) {
  Finding finding = finding_at(FindingId::kToolUndefined, Severity::kError, m, step);
  finding.tool = tool.number;
  if (!tool.trouble.empty()) {
    finding.text = trf("tool {}: {}; its moves do not cut", m.tool, tool.trouble);
  } else if (m.tool == 0) {
    finding.text =
        tr("feed moves with no tool in the spindle do not cut (one --tool N=SHAPE names the tool "
           "that is in it at the start)");
  } else {
    finding.text =
        trf("nothing is known of tool {}; its moves do not cut (--tool {}=SHAPE describes it)",
            m.tool, m.tool);
    finding.hint = hint_of_number(m.tool);
  }
  log.add(std::move(finding));
}

}  // namespace kerf
