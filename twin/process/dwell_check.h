// twin/process/dwell_check.h - dwells that last for minutes.
#pragma once

#include <cstdint>

#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// long-dwell. LinuxCNC takes the P of G4, G82, G86, G88 and G89 in seconds, where many controls
/// take milliseconds: P500 stands still for eight minutes. One thread.
class DwellCheck {
 public:
  /// A spindle that warms up may be given a minute.
  static constexpr double kLong_s = 100;

  explicit DwellCheck(FindingLog& log) : log_(log) {}
  void note(const Motion& motion, const TimedStep& step);
  /// At the end: one finding for the whole program. A cycle dwells in each of its holes.
  void report();
  void forget() { count_ = 0, sum_s_ = 0; }

 private:
  FindingLog& log_;
  std::uint64_t count_ = 0;
  SourceRef source_;  ///< the first
  double time_s_ = 0, sum_s_ = 0;
};

}  // namespace kerf
