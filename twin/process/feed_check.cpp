#include "twin/process/feed_check.h"

#include <cmath>

#include "base/translate.h"
#include "twin/process/finding_at.h"

namespace kerf {
namespace {

/// Rounded limits of an INI are no finding.
constexpr double kOverFeed = 1.01;

}  // namespace

void FeedCheck::note(const Motion& m, const TimedStep& step) {
  if (step.length_mm <= 0) return;
  if (m.kind == MotionKind::kThread) {
    check_thread(m, step);
  } else if (step.programmed_mm_per_min <= 0) {
    tell_missing(m, step);
  } else if (step.programmed_mm_per_min > kOverFeed * step.allowed_mm_per_min) {
    if (over_.count++ > 0) return;
    over_ = {1, m.source, step.start_s, step.programmed_mm_per_min, step.allowed_mm_per_min};
  }
}

void FeedCheck::tell_missing(const Motion& m, const TimedStep& step) {
  if (std::exchange(missing_told_, true)) return;
  Finding finding = finding_at(FindingId::kFeedMissing, Severity::kWarning, m, step);
  finding.text =
      tr("feed move without a feed rate (or without spindle speed under G95); it takes no time in "
         "this report");
  log_.add(std::move(finding));
}

/// Of G33, G76 and G33.1. A block of several passes is told once.
void FeedCheck::check_thread(const Motion& m, const TimedStep& step) {
  constexpr double kSlack = 1 + 1e-6;
  if (m.source == thread_told_ || step.allowed_mm_per_min <= 0 ||
      step.programmed_mm_per_min <= step.allowed_mm_per_min * kSlack) {
    return;
  }
  thread_told_ = m.source;
  Finding finding = finding_at(FindingId::kThreadSpeed,
                               limits_known_ ? Severity::kError : Severity::kWarning, m, step);
  finding.tool = m.tool;
  finding.text =
      trf("the thread's {:g} mm a turn at {:.0f} rpm ask for {:.0f} mm/min, and the axes do "
          "{:.0f}: they cannot follow the spindle{}",
          m.feed_mm_per_min, m.spindle_rpm, step.programmed_mm_per_min, step.allowed_mm_per_min,
          limits_known_ ? "" : tr(" (of an assumed machine)"));
  finding.hint = trf("at most S{:.0f}", std::floor(m.spindle_rpm * step.allowed_mm_per_min /
                                                   step.programmed_mm_per_min));
  log_.add(std::move(finding));
}

void FeedCheck::report() {
  if (over_.count == 0) return;
  Finding finding =
      finding_at(FindingId::kOverFeed, limits_known_ ? Severity::kWarning : Severity::kNote,
                 over_.source, over_.time_s);
  finding.text = trnf("{} feed move asks for more than the machine can do",
                      "{} feed moves ask for more than the machine can do", over_.count) +
                 trf(", the first for {:.0f} mm/min where it can do {:.0f} mm/min ({})",
                     over_.programmed_mm_per_min, over_.allowed_mm_per_min, tr(origin_.c_str()));
  log_.add(std::move(finding));
}

}  // namespace kerf
