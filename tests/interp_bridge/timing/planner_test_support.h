// tests/interp_bridge/timing/planner_test_support.h - motions written by hand, and a plan kept.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/timing/planner.h"

namespace kerf {

struct Plan : MotionPlanSink {
  std::vector<MotionTiming> timings;
  std::vector<PathPiece> pieces;
  std::vector<std::size_t> pieces_before;  ///< per motion: pieces that had come when it was timed
  void timed(const MotionTiming& timing) override {
    timings.push_back(timing);
    pieces_before.push_back(pieces.size());
  }
  void path(const PathPiece& piece) override { pieces.push_back(piece); }
  double clock_s = 0;
};

inline Plan plan_of(std::span<const Motion> motions,
                    const MachineLimits& limits = MachineLimits::small_mill(),
                    PlannerOptions options = {}) {
  Plan plan;
  TrajectoryPlanner planner(limits, options, plan);
  for (const Motion& m : motions) planner.push(m);
  planner.finish();
  plan.clock_s = planner.clock_s();
  return plan;
}

inline double length_of(const PathPiece& p) {
  if (!p.curved) return glm::length(p.to_mm - p.from_mm);
  const Vec3 d0 = p.from_mm - p.arc.center_mm;
  const double along = glm::dot(p.to_mm - p.from_mm, p.arc.axis);
  const double radius = glm::length(d0 - glm::dot(d0, p.arc.axis) * p.arc.axis);
  return std::hypot(radius * p.arc.sweep_rad, along);
}

inline double path_length(const Plan& plan) {
  double sum = 0;
  for (const PathPiece& p : plan.pieces) sum += length_of(p);
  return sum;
}

/// Motions one after the other, each from where the last one ended.
class Path {
 public:
  explicit Path(PathMode mode = PathMode::kContinuous, double tolerance_mm = 0,
                double merge_mm = 0) {
    state_.path_mode = mode;
    state_.blend_tolerance_mm = static_cast<float>(tolerance_mm);
    state_.merge_tolerance_mm = static_cast<float>(merge_mm);
  }
  Path& feed(double mm_per_min) {
    state_.feed_mm_per_min = mm_per_min;
    return *this;
  }
  Path& line(double x, double y, double z = 0) { return move(MotionKind::kFeed, {x, y, z}); }
  Path& rapid(double x, double y, double z = 0) { return move(MotionKind::kTraverse, {x, y, z}); }
  Path& arc(double x, double y, double cx, double cy, double sweep_rad) {
    move(MotionKind::kArc, {x, y, at_.z});
    motions.back().arc = {{cx, cy, 0}, {0, 0, 1}, sweep_rad};
    return *this;
  }
  Path& turn(double a_deg) {
    abc_[0] = a_deg;
    return move(MotionKind::kFeed, at_);
  }
  Path& dwell(double seconds) {
    move(MotionKind::kDwell, at_);
    motions.back().duration_s = seconds;
    return *this;
  }
  Path& step(MotionKind kind) { return move(kind, at_); }
  Motion& state() { return state_; }
  std::vector<Motion> motions;

 private:
  Path& move(MotionKind kind, const Vec3& to) {
    Motion m = state_;
    m.kind = kind;
    if (kind == MotionKind::kTraverse) m.feed_mm_per_min = 0;
    m.from_mm = at_;
    m.to_mm = to;
    m.from_abc_deg = last_abc_;
    m.to_abc_deg = abc_;
    last_abc_ = abc_;
    at_ = to;
    motions.push_back(m);
    return *this;
  }
  Motion state_;
  Vec3 at_{0};
  std::array<double, 3> abc_{};
  std::array<double, 3> last_abc_{};
};

}  // namespace kerf
