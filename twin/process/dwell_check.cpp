#include "twin/process/dwell_check.h"

#include <utility>

#include "base/translate.h"
#include "twin/process/finding_at.h"

namespace kerf {

void DwellCheck::note(const Motion& m, const TimedStep& step) {
  if (m.kind != MotionKind::kDwell || m.duration_s < kLong_s) return;
  if (count_++ == 0) source_ = m.source, time_s_ = step.start_s;
  sum_s_ += m.duration_s;
}

void DwellCheck::report() {
  if (count_ == 0) return;
  Finding finding = finding_at(FindingId::kLongDwell, Severity::kNote, source_, time_s_);
  finding.text =
      trnf("{} dwell of a hundred seconds or more", "{} dwells of a hundred seconds or more",
           count_) +
      trf(", {:.0f} s in all; LinuxCNC takes P in seconds, many controls in milliseconds", sum_s_);
  log_.add(std::move(finding));
}

}  // namespace kerf
