#include "twin/process/turning/speed_checks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"
#include "interp_bridge/timing/spindle_speed.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/finding_at.h"

namespace kerf {
namespace {

/// Speeds that are worked out from one another differ by rounding.
constexpr double kSpeedSlack = 1 + 1e-6;
/// A cap above this is none.
constexpr double kNoCap_rpm = 1e9;

std::string over_speed_text(const Motion& m, double rpm, double max_rpm) {
  const double m_per_min = m.surface.mm_per_min / 1000;
  if (max_rpm <= 0) {
    return trf(
        "G96 without D: {:.0f} m/min ask for ever more turns towards the axis, {:.0f} rpm at "
        "a radius of {:g} mm",
        m_per_min, rpm, SurfaceSpeed::kSmallestRadius_mm);
  }
  if (!m.surface.on())
    return trf("S asks for {:.0f} rpm, and the spindle does {:.0f}", rpm, max_rpm);
  return trf("G96 with {:.0f} m/min asks for up to {:.0f} rpm, and the spindle does {:.0f}",
             m_per_min, rpm, max_rpm);
}

}  // namespace

void SpeedChecks::check(const Motion& m, const TimedStep& step, double max_rpm) {
  if (m.spindle == SpindleState::kStopped || !m.start_known) return;
  const SpindlePeak peak = peak_spindle_rpm(m);
  const bool unbounded = max_rpm <= 0 && m.surface.on() && m.surface.max_rpm >= kNoCap_rpm &&
                         is_feed(m) &&
                         peak.rpm * kSpeedSlack >= m.surface.rpm_at(m.surface.axis_x_mm);
  if (!unbounded && (max_rpm <= 0 || peak.rpm <= max_rpm * kSpeedSlack)) return;
  std::string text = over_speed_text(m, peak.rpm, max_rpm);
  if (event_) {
    if (peak.rpm <= told_rpm_) return;
    told_rpm_ = peak.rpm;
    log_.reword(*event_, std::move(text));
    return;
  }
  Finding finding =
      finding_at(FindingId::kOverSpeed, max_rpm > 0 ? Severity::kError : Severity::kWarning,
                 m.source, step.time_at(peak.share));
  finding.text = std::move(text);
  finding.tool = m.tool;
  if (is_feed(m) || is_traverse(m)) finding.position_mm = point_at(m, peak.share);
  finding.hint = m.surface.on() ? tr("D behind G96 caps the speed: G96 D2500 S200")
                                : tr("a lower S; --spindle-max is what the spindle does");
  event_ = log_.add(std::move(finding));
  told_rpm_ = peak.rpm;
}

}  // namespace kerf
