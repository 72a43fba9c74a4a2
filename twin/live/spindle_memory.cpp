#include "twin/live/spindle_memory.h"

#include <cmath>

namespace kerf {
namespace {

/// A spindle slower than this stands. rpm.
constexpr double kSpindleStands_rpm = 1.0;
/// One that was told to stop still turns for so long, s; and where no program runs any more.
constexpr double kCoasts_s = 0.15;
constexpr double kCoastsIdle_s = 1.0;

}  // namespace

void SpindleMemory::take(const AxisSample& sample, double t_s) {
  if (!(std::abs(sample.spindle_rpm) >= kSpindleStands_rpm)) return;
  turning_rpm_ = sample.spindle_rpm;
  turning_until_s_ = t_s;
}

SpindleNow SpindleMemory::now(const AxisSample& sample, double t_s, double unseen_s,
                              bool idle) const {
  SpindleNow out;
  out.state = state(sample, t_s, unseen_s, idle);
  out.said = !std::isnan(sample.spindle_rpm);
  if (!out.said) return out;
  // What the machine says, or while it says next to nothing what it was told last.
  const double rpm = std::abs(sample.spindle_rpm);
  const bool coasts = out.state != SpindleState::kStopped && rpm < kSpindleStands_rpm;
  out.rpm = coasts ? std::abs(turning_rpm_) : rpm;
  return out;
}

SpindleState SpindleMemory::state(const AxisSample& sample, double t_s, double unseen_s,
                                  bool idle) const {
  // What nobody tells cannot be found wrong; a beam that nobody tells of is off.
  if (std::isnan(sample.spindle_rpm)) {
    return has_beam_ ? SpindleState::kStopped : SpindleState::kClockwise;
  }
  double rpm = sample.spindle_rpm;
  if (std::abs(rpm) < kSpindleStands_rpm) {
    // An abort stops spindle and axes together, and takes the axes some way. When it was nobody
    // knows of a spindle that turned before the time out of sight.
    const double coasts_s = unseen_s + (idle ? kCoastsIdle_s : kCoasts_s);
    const bool coasts = !has_beam_ && turning_until_s_ && t_s - *turning_until_s_ <= coasts_s;
    if (!coasts) return SpindleState::kStopped;
    rpm = turning_rpm_;
  }
  return rpm > 0 ? SpindleState::kClockwise : SpindleState::kCounterclockwise;
}

}  // namespace kerf
