// twin/process/finding_at.h - findings about a motion.
#pragma once

#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// Without a text, of no tool.
inline Finding finding_at(FindingId id, Severity severity, SourceRef source, double time_s) {
  Finding finding;
  finding.id = id;
  finding.severity = severity;
  finding.source = source;
  finding.time_s = time_s;
  return finding;
}
/// Where the motion begins in time.
inline Finding finding_at(FindingId id, Severity severity, const Motion& motion,
                          const TimedStep& step) {
  return finding_at(id, severity, motion.source, step.start_s);
}

}  // namespace kerf
