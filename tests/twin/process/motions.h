// tests/twin/process/motions.h - motions by hand, one after the other.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interp_bridge/motion.h"

namespace kerf {

/// A program written as calls: every motion starts where the one before ended, each on a line of
/// its own.
class MotionList {
 public:
  MotionList& tool(int number) {
    state_.tool = number;
    Motion m = next(MotionKind::kToolChange);
    list_.push_back(m);
    return *this;
  }
  MotionList& spindle(bool on) {
    state_.spindle = on ? SpindleState::kClockwise : SpindleState::kStopped;
    state_.spindle_rpm = on ? 10000 : 0;
    state_.torch.spindles_on = on ? 1 : 0;
    return *this;
  }
  /// Bit n: M3 $n.
  MotionList& spindles(std::uint8_t on) {
    state_.torch.spindles_on = on;
    return *this;
  }
  /// Of the spindle that is on.
  MotionList& rpm(double speed) {
    state_.spindle_rpm = speed;
    return *this;
  }
  MotionList& output(unsigned n, bool on) {
    const std::uint64_t bit = std::uint64_t{1} << n;
    state_.torch.outputs = on ? state_.torch.outputs | bit : state_.torch.outputs & ~bit;
    return *this;
  }
  MotionList& analog(unsigned n, double value) {
    state_.torch.analog[n] = static_cast<float>(value);
    return *this;
  }
  MotionList& turned(std::array<double, 3> abc_deg) {
    state_.from_abc_deg = state_.to_abc_deg = abc_deg;
    return *this;
  }
  MotionList& at(Vec3 place) {
    state_.to_mm = place;
    return *this;
  }
  MotionList& feed_rate(double mm_per_min) {
    feed_ = mm_per_min;
    return *this;
  }
  MotionList& traverse(Vec3 to) { return move(MotionKind::kTraverse, to); }
  MotionList& feed(Vec3 to) { return move(MotionKind::kFeed, to); }
  MotionList& probe(Vec3 to) { return move(MotionKind::kProbe, to); }
  /// As G33 gives it: so far along the way in a turn.
  MotionList& thread(Vec3 to, double lead_mm) {
    move(MotionKind::kThread, to);
    list_.back().feed_per_rev = true;
    list_.back().feed_mm_per_min = lead_mm;
    return *this;
  }
  MotionList& arc(Vec3 to, Vec3 center, Vec3 axis, double sweep_rad) {
    move(MotionKind::kArc, to);
    list_.back().arc = ArcGeometry{center, axis, sweep_rad};
    return *this;
  }
  /// What has been switched, or a user M-code, where signals are wanted.
  MotionList& signal(std::uint8_t user_m = 0) {
    Motion m = next(MotionKind::kSignal);
    m.user_m = user_m;
    list_.push_back(m);
    return *this;
  }
  MotionList& dwell(double seconds) {
    Motion m = next(MotionKind::kDwell);
    m.duration_s = seconds;
    list_.push_back(m);
    return *this;
  }

  Motion& last() { return list_.back(); }
  const std::vector<Motion>& list() const { return list_; }

 private:
  Motion next(MotionKind kind) {
    Motion m = state_;
    m.kind = kind;
    m.from_mm = state_.to_mm;
    m.source.line = ++line_;
    return m;
  }
  MotionList& move(MotionKind kind, Vec3 to) {
    Motion m = next(kind);
    m.to_mm = to;
    m.feed_mm_per_min = kind == MotionKind::kTraverse ? 0 : feed_;
    state_.to_mm = to;
    list_.push_back(m);
    return *this;
  }

  Motion state_;
  double feed_ = 600;
  std::uint32_t line_ = 0;
  std::vector<Motion> list_;
};

}  // namespace kerf
