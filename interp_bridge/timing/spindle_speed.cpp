#include "interp_bridge/timing/spindle_speed.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"

namespace kerf {
namespace {

/// Steps in which a way under G96 is looked at.
constexpr int kWaySteps = 128;
/// Longest step in time of a spindle that changes its speed.
constexpr double kTimeStep_s = 0.001;
/// No spindle takes longer: it does not get to its speed.
constexpr double kLongestWait_s = 120;

/// X of the tip along a motion. LinuxCNC's arcs turn evenly, and grow so.
double x_at(const Motion& m, double share) {
  const bool turns = m.kind == MotionKind::kArc && m.arc.sweep_rad != 0;
  if (!turns) return m.from_mm.x + share * (m.to_mm.x - m.from_mm.x);
  const Vec3 out = m.from_mm - m.arc.center_mm;
  const Vec3 end = m.to_mm - m.arc.center_mm;
  const double along = glm::dot(out, m.arc.axis);
  const Vec3 flat = out - along * m.arc.axis;
  const double rise = glm::dot(end, m.arc.axis) - along;
  const double radius = glm::length(flat);
  const double last = glm::length(end - (along + rise) * m.arc.axis);
  const double grown = radius > 0 ? 1 + share * (last / radius - 1) : 1;
  const double angle = share * m.arc.sweep_rad;
  const Vec3 side = glm::cross(m.arc.axis, flat);
  return m.arc.center_mm.x +
         grown * (portable::cos(angle) * flat.x + portable::sin(angle) * side.x) +
         (along + share * rise) * m.arc.axis.x;
}

/// Share of the way, from `low` to `high`, at which an arc is nearest to the axis.
double nearest_between(const Motion& m, double low, double high) {
  const auto radius = [&](double share) { return std::abs(x_at(m, share) - m.surface.axis_x_mm); };
  while (high - low > 1e-5) {
    const double one = low + (high - low) / 3;
    const double two = high - (high - low) / 3;
    (radius(one) <= radius(two) ? high : low) = radius(one) <= radius(two) ? two : one;
  }
  return (low + high) / 2;
}

double signed_by(const Motion& m, double rpm) {
  if (m.spindle == SpindleState::kStopped) return 0;
  return m.spindle == SpindleState::kCounterclockwise ? -rpm : rpm;
}

bool changes(const Motion& m) { return m.surface.on() && m.from_mm != m.to_mm; }

}  // namespace

double spindle_rpm_at(const Motion& m, double share) {
  return m.surface.on() ? m.surface.rpm_at(x_at(m, share)) : m.spindle_rpm;
}

double commanded_rpm(const Motion& m, double share) {
  return signed_by(m, spindle_rpm_at(m, share));
}

SpindlePeak peak_spindle_rpm(const Motion& m) {
  if (!m.surface.on()) return {m.spindle_rpm, 0};
  if (m.kind != MotionKind::kArc) {
    // Nearest to the axis, or as near as the cap is reached first.
    const double cap_mm = m.surface.mm_per_min / (2 * kPi * m.surface.max_rpm);
    const double floor_mm = std::max(cap_mm, SurfaceSpeed::kSmallestRadius_mm);
    const double from = m.from_mm.x - m.surface.axis_x_mm;
    const double way = m.to_mm.x - m.from_mm.x;
    double share = std::abs(from + way) < std::abs(from) || from * (from + way) < 0 ? 1 : 0;
    if (share > 0) {
      const double to_mm = from < 0 ? -floor_mm : floor_mm;
      share = std::abs(from) <= floor_mm ? 0 : std::min((to_mm - from) / way, 1.0);
    }
    return {spindle_rpm_at(m, share), share};
  }
  SpindlePeak peak;
  double nearest = std::abs(x_at(m, 0) - m.surface.axis_x_mm);
  int where = 0;
  for (int i = 1; i <= kWaySteps; ++i) {
    const double radius =
        std::abs(x_at(m, static_cast<double>(i) / kWaySteps) - m.surface.axis_x_mm);
    if (radius >= nearest) continue;
    nearest = radius;
    where = i;
  }
  peak.share = static_cast<double>(where) / kWaySteps;
  if (where > 0 && where < kWaySteps) {
    const double step = 1.0 / kWaySteps;
    peak.share = nearest_between(m, peak.share - step, peak.share + step);
  }
  peak.rpm = spindle_rpm_at(m, peak.share);
  return peak;
}

void cap_speed(Motion& m, double max_rpm) {
  m.spindle_rpm = std::min(m.spindle_rpm, max_rpm);
  m.surface.max_rpm = std::min(m.surface.max_rpm, max_rpm);
}

void SpindleSpeed::step(double commanded, double seconds) {
  const double most = drive_.accel_rpm_per_s * seconds;
  rpm_ += std::clamp(commanded - rpm_, -most, most);
  measured_rpm_ += (rpm_ - measured_rpm_) * -std::expm1(-seconds / SpindleDrive::kMeasured_s);
}

void SpindleSpeed::stand(double commanded, double seconds) {
  if (!drive_.known() || seconds <= 0) return;
  // Until it is there in small steps; then one is enough.
  while (seconds > 0) {
    const bool there = rpm_ == commanded;
    const double now = there ? seconds : std::min(seconds, kTimeStep_s);
    step(commanded, now);
    seconds -= now;
  }
}

void SpindleSpeed::follow(const Motion& m, double seconds, const WayInTime& way, double end_rpm) {
  if (!drive_.known() || seconds <= 0) return;
  if (end_rpm >= 0) {
    rpm_ = measured_rpm_ = signed_by(m, end_rpm);
    return;
  }
  if (!changes(m)) return stand(commanded_rpm(m, 1), seconds);
  const double steps = std::ceil(std::min(seconds / kTimeStep_s, 10.0 * kWaySteps));
  for (int i = 1; i <= static_cast<int>(steps); ++i) {
    step(commanded_rpm(m, way.way_of(i / steps)), seconds / steps);
  }
}

bool SpindleSpeed::is_near(double commanded) const {
  const double wanted = std::abs(commanded);
  const double measured = commanded < 0 ? -measured_rpm_ : measured_rpm_;
  return std::abs(wanted - measured) <= SpindleDrive::kNear_rpm ||
         (wanted / SpindleDrive::kNearShare <= measured &&
          measured <= wanted * SpindleDrive::kNearShare);
}

double SpindleSpeed::wait_until_near(double commanded) {
  if (!drive_.known()) return 0;
  double waited = 0;
  while (!is_near(commanded) && waited < kLongestWait_s) {
    step(commanded, kTimeStep_s);
    waited += kTimeStep_s;
  }
  return waited;
}

SpindleFeed spindle_feed(const Motion& m, double feed_mm, double length_mm,
                         const SpindleDrive& drive, double start_rpm, double most_mm_per_s) {
  SpindleFeed feed;
  const double per_rpm = feed_mm / 60.0;
  feed.most = per_rpm * peak_spindle_rpm(m).rpm;
  feed.end_rpm = spindle_rpm_at(m, 1);
  if (!changes(m) || feed.most <= 0) {
    feed.mean = feed.most;
    return feed;
  }
  const double step_mm = length_mm / kWaySteps;
  double rpm = start_rpm >= 0 && drive.known() ? start_rpm : spindle_rpm_at(m, 0);
  const auto slowness = [&](double at_rpm) {
    return 1 / std::max(std::min(per_rpm * at_rpm, most_mm_per_s), step_mm / kLongestWait_s);
  };
  feed.slow_from = slowness(rpm);
  double seconds = 0;
  for (int i = 1; i <= kWaySteps; ++i) {
    double next = spindle_rpm_at(m, static_cast<double>(i) / kWaySteps);
    if (drive.known()) {
      // The time of the step by the speed at its start: late by a part of a step.
      const double most =
          drive.accel_rpm_per_s * step_mm / std::max(per_rpm * rpm, step_mm / kLongestWait_s);
      next = std::clamp(next, rpm - most, rpm + most);
    }
    const double mean = std::min(per_rpm * (rpm + next) / 2, most_mm_per_s);
    seconds += step_mm / std::max(mean, step_mm / kLongestWait_s);
    rpm = next;
  }
  feed.mean = length_mm / seconds;
  feed.end_rpm = rpm;
  feed.slow_to = slowness(rpm);
  return feed;
}

}  // namespace kerf
