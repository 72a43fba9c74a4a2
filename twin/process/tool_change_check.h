// twin/process/tool_change_check.h - a tool that is selected and not changed.
#pragma once

#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// Watches one program in its order.
class ToolChangeCheck {
 public:
  explicit ToolChangeCheck(FindingLog& log) : log_(log) {}

  /// tool-not-changed, of feed moves with tool number `tool`, before they are cut. A T word waits
  /// from its line on; feed moves of another tool meanwhile are told when the next T word or the
  /// program's end shows that no M6 comes; the same T word again goes on waiting (T2 .. T2 M6).
  /// What is fetched ahead for a change to come is sound, and so is a last T word behind which
  /// nothing is fed.
  void feeds(const Motion& motion, const TimedStep& step, int tool);
  /// The tool is changed.
  void end_tool() { waiting_ = {}; }
  /// What went on before is not reported on.
  void forget_events() { waiting_.fed = false; }
  /// The program is over (`whole`), or goes on behind what was seen of it.
  void finish(bool whole) {
    if (whole) tell_not_changed();
  }

 private:
  struct Waiting {
    int tool = 0;       ///< T word
    SourceRef source;   ///< of it, where it came first
    SourceRef last;     ///< .. and last
    int used = 0;       ///< instead
    SourceRef first;    ///< its first feed move
    double time_s = 0;  ///< of that
    bool fed = false;
  };
  void tell_not_changed();

  FindingLog& log_;
  Waiting waiting_;
};

}  // namespace kerf
