#include "twin/live/sample_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"

namespace kerf {
namespace {

/// Two samples nearer to each other say nothing of a speed.
constexpr double kShortest_s = 0.0005;

}  // namespace

MotionBounds motion_bounds(const LiveFrameOptions& frame, const TimelineOptions& timeline,
                           const PositionMost& most) {
  MotionBounds out;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    MotionBounds::Bound& bound = out.bounds[i];
    const MachineKinematics* const machine = frame.kinematics.get();
    int axis = frame.axis[i];
    if (machine) {
      const std::string& letters = machine->joint_letters;
      const auto letter = std::find(kAxisLetters.begin(), kAxisLetters.end(),
                                    i < letters.size() ? letters[i] : '?');
      axis = letter == kAxisLetters.end() ? -1 : static_cast<int>(letter - kAxisLetters.begin());
    }
    if (axis < 0 || is_rotary_axis(static_cast<std::size_t>(axis))) continue;
    if (machine && machine->is_arm()) continue;
    const auto at = static_cast<std::size_t>(axis);
    bound.judged = true;
    bound.name = machine ? trf("joint {}", i) : std::string(1, kAxisLetters[at]);
    const AxisLimits& limits = machine ? timeline.joint_limits[at] : timeline.limits.axes[at];
    const bool known = timeline.limits_known && limits.present;
    if (known && limits.max_acceleration > 0) bound.most_per_s2 = limits.max_acceleration;
    if (known && limits.max_velocity > 0) bound.most_per_s = limits.max_velocity;
    if (std::isfinite(most.per_s)) bound.most_per_s = most.per_s;
    if (std::isfinite(most.of_position_per_s[i])) bound.most_per_s = most.of_position_per_s[i];
    if (most.per_s2 > 0) bound.most_per_s2 = most.per_s2;
  }
  return out;
}

/// How far from its neighbours a position can have been, `between_s` apart.
double SampleGate::farthest_mm(std::size_t index, double between_s) const {
  const MotionBounds::Bound& bound = bounds_.bounds[index];
  const double time_s = between_s + kInexact_s;
  return kFloor_mm +
         kFactor * std::min(bound.most_per_s2 * time_s * time_s / 8, bound.most_per_s * time_s / 2);
}

/// Not where the machine would be if it went on, by more than it can be off and back in the next.
bool SampleGate::is_suspect(const Timed& next) const {
  const double step_s = next.t_s - last_.t_s;
  if (step_s > gap_s_) return false;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (!bounds_.bounds[i].judged || !next.sample.has(i) || !last_.sample.has(i)) continue;
    const double at_mm = last_.sample.position[i];
    const double on_mm = at_mm + speed_[i] * step_s;
    const double is_mm = next.sample.position[i];
    const double off_mm = std::max(std::min(at_mm, on_mm) - is_mm, is_mm - std::max(at_mm, on_mm));
    if (off_mm > farthest_mm(i, 2 * step_s)) return true;
  }
  return false;
}

bool SampleGate::is_wild(const Timed& one, const Timed& next) {
  const double between_s = next.t_s - last_.t_s;
  if (between_s > gap_s_) return false;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    const MotionBounds::Bound& bound = bounds_.bounds[i];
    if (!bound.judged || !one.sample.has(i) || !last_.sample.has(i) || !next.sample.has(i)) {
      continue;
    }
    const auto [low_mm, high_mm] = std::minmax(last_.sample.position[i], next.sample.position[i]);
    const double is_mm = one.sample.position[i];
    const double off_mm = std::max(low_mm - is_mm, is_mm - high_mm);
    if (off_mm <= farthest_mm(i, between_s)) continue;
    fault_ = trf(
        "{} reads {:g} mm, {:.2f} mm away from where it is before and after, within {:.3f} s: no "
        "machine is so quick",
        bound.name, is_mm, off_mm, between_s);
    return true;
  }
  return false;
}

void SampleGate::pass(const Timed& one, std::vector<Timed>& out) {
  const double step_s = one.t_s - last_.t_s;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    const bool known = has_last_ && one.sample.has(i) && last_.sample.has(i);
    if (!known) {
      speed_[i] = 0;
    } else if (step_s >= kShortest_s) {
      speed_[i] = (one.sample.position[i] - last_.sample.position[i]) / step_s;
    }
  }
  has_last_ = true;
  last_ = one;
  out.push_back(one);
}

std::size_t SampleGate::take(const Timed& next, std::vector<Timed>& out) {
  if (has_last_ && is_suspect(next) && waiting_count_ < kMostWild) {
    waiting_[waiting_count_++] = next;
    return 0;
  }
  std::size_t wild = 0;
  Timed passing = next;
  // The machine is elsewhere when even the last that may wait is followed by one like it.
  const bool is_back = !has_last_ || !is_suspect(next);
  for (std::size_t i = 0; i < waiting_count_; ++i) {
    if (is_back && is_wild(waiting_[i], next)) {
      ++wild;
      passing.lost |= waiting_[i].lost;
    } else {
      pass(waiting_[i], out);
    }
  }
  waiting_count_ = 0;
  pass(passing, out);
  return wild;
}

void SampleGate::finish(std::vector<Timed>& out) {
  for (std::size_t i = 0; i < waiting_count_; ++i) pass(waiting_[i], out);
  waiting_count_ = 0;
}

}  // namespace kerf
