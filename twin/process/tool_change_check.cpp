#include "twin/process/tool_change_check.h"

#include <utility>

#include "base/translate.h"
#include "twin/job/tool_number.h"

namespace kerf {

void ToolChangeCheck::feeds(const Motion& m, const TimedStep& step, int tool) {
  if (m.selected_at != waiting_.last) {
    const bool same = m.selected_tool == waiting_.tool && m.selected_at.line != 0;
    if (!same) {
      tell_not_changed();
      waiting_ = {m.selected_tool, m.selected_at, m.selected_at, 0, {}, 0, false};
    }
    waiting_.last = m.selected_at;
  }
  if (waiting_.fed || waiting_.source.line == 0 || waiting_.tool <= 0) return;
  if (tool == waiting_.tool) return;
  waiting_.fed = true;
  waiting_.used = tool;
  waiting_.first = m.source;
  waiting_.time_s = step.start_s;
}

void ToolChangeCheck::tell_not_changed() {
  if (!waiting_.fed) return;
  waiting_.fed = false;
  Finding finding;
  finding.id = FindingId::kToolNotChanged;
  finding.severity = Severity::kWarning;
  finding.source = waiting_.source;
  finding.time_s = waiting_.time_s;
  finding.tool = waiting_.used;
  finding.text = trf("T{} is selected, and no M6 follows: tool {} cuts on, from line {}",
                     waiting_.tool, waiting_.used, waiting_.first.line);
  finding.hint = hint_of_number(waiting_.tool);
  log_.add(std::move(finding));
}

}  // namespace kerf
