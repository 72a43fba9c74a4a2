// twin/process/turning/speed_checks.h - how fast the workpiece is asked to turn: over-speed.
#pragma once

#include <optional>

#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// The speed that is commanded along each motion, with G96 the greatest on its way. Above what the
/// spindle does it is told; where nobody has said what that is, a G96 without D that comes to the
/// axis, where the speed has no bound. Once from a tool change to the next.
class SpeedChecks {
 public:
  explicit SpeedChecks(FindingLog& log) : log_(log) {}

  /// Any motion. `max_rpm`: CheckOptions::spindle_max_rpm.
  void check(const Motion& motion, const TimedStep& step, double max_rpm);
  void end_tool() { event_.reset(); }

 private:
  FindingLog& log_;
  std::optional<FindingLog::Handle> event_;
  double told_rpm_ = 0;
};

}  // namespace kerf
