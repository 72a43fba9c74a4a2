// tests/twin/diff/diff_support.h - programs of a few steps.
#pragma once

#include <cmath>
#include <vector>

#include "twin/diff/diff_steps.h"

namespace kerf {

/// Steps that go on from where the last one ended.
class StepWriter {
 public:
  explicit StepWriter(const Vec3& from = Vec3(0)) : at_(from) { now_.tool = 1; }

  StepWriter& feed_rate(double mm_per_min) {
    feed_ = mm_per_min;
    return *this;
  }
  DiffStep& state() { return now_; }
  StepWriter& feed(const Vec3& to) { return add(MotionKind::kFeed, to); }
  StepWriter& rapid(const Vec3& to) { return add(MotionKind::kTraverse, to); }
  /// About an axis along Z.
  StepWriter& arc(const Vec3& center, double sweep_rad) {
    const Vec3 from = at_ - center;
    const double c = std::cos(sweep_rad), s = std::sin(sweep_rad);
    add(MotionKind::kArc, center + Vec3(c * from.x - s * from.y, s * from.x + c * from.y, from.z));
    steps_.back().arc.center_mm = center;
    steps_.back().arc.sweep_rad = sweep_rad;
    return *this;
  }
  /// The same arc as so many chords.
  StepWriter& chords(const Vec3& center, double sweep_rad, int count) {
    const Vec3 from = at_ - center;
    for (int i = 1; i <= count; ++i) {
      const double angle = sweep_rad * i / count;
      const double c = std::cos(angle), s = std::sin(angle);
      feed(center + Vec3(c * from.x - s * from.y, s * from.x + c * from.y, from.z));
    }
    return *this;
  }
  StepWriter& dwell(double seconds) {
    add(MotionKind::kDwell, at_);
    steps_.back().dwell_s = seconds;
    return *this;
  }

  std::vector<DiffStep> steps() const { return steps_; }

 private:
  StepWriter& add(MotionKind kind, const Vec3& to) {
    DiffStep step = now_;
    step.kind = kind;
    step.feed = kind == MotionKind::kTraverse ? 0 : feed_;
    step.source.line = ++line_;
    step.from_mm = at_;
    step.to_mm = at_ = to;
    steps_.push_back(step);
    return *this;
  }

  DiffStep now_;
  Vec3 at_;
  double feed_ = 600;
  std::uint32_t line_ = 0;
  std::vector<DiffStep> steps_;
};

}  // namespace kerf
