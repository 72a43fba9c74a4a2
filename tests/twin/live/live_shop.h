// tests/twin/live/live_shop.h - a program, a machine that runs it, and samples of that machine.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "interp_bridge/program.h"
#include "machine_io/position_source.h"
#include "tests/twin/process/motions.h"
#include "twin/machine/timeline.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {

/// Motions in place of an interpreter.
class ListedProgram final : public Program {
 public:
  explicit ListedProgram(std::vector<Motion> motions) : motions_(std::move(motions)) {}
  const std::vector<ProgramComment>& comments() const override { return comments_; }
  ProgramSummary run(const MotionSink& sink, std::stop_token stop, Diagnostics&) override {
    files_ = {"part.ngc"};
    ProgramSummary summary;
    summary.files = files_;
    summary.has_program_end = true;
    for (std::size_t at = 0; at < motions_.size() && !stop.stop_requested(); at += 100) {
      const std::size_t count = std::min<std::size_t>(100, motions_.size() - at);
      if (!sink(std::span<const Motion>(motions_).subspan(at, count))) break;
    }
    return summary;
  }
  double progress() const override { return -1; }

 private:
  std::vector<Motion> motions_;
  std::vector<ProgramComment> comments_;
};

/// A motion with its time, as the planner has it.
struct TimedMotion {
  Motion motion;
  TimedStep step;
};

class MotionTimes : private StepSink {
 public:
  explicit MotionTimes(std::span<const Motion> motions) {
    Timeline timeline(TimelineOptions{}, *this);
    for (const Motion& m : motions) timeline.push(m);
    timeline.finish();
  }
  std::vector<TimedMotion> list;

 private:
  void step(const Motion& motion, const TimedStep& timed, std::span<const PathPiece>) override {
    list.push_back({motion, timed});
  }
};

/// A machine that runs the motions by the plan, each at its mean speed.
class RunningMachine {
 public:
  explicit RunningMachine(std::span<const Motion> motions) : times_(motions) {}

  double duration_s() const {
    return times_.list.back().step.start_s + times_.list.back().step.duration_s;
  }
  const TimedMotion& at(double t_s) const {
    const auto after =
        std::upper_bound(times_.list.begin(), times_.list.end(), t_s,
                         [](double t, const TimedMotion& m) { return t < m.step.start_s; });
    return after == times_.list.begin() ? times_.list.front() : *(after - 1);
  }
  Vec3 tip(double t_s) const {
    const TimedMotion& m = at(t_s);
    return point_at(m.motion, m.step.way_at(t_s));
  }
  AxisSample sample(double t_s, bool with_line = false) const {
    AxisSample sample;
    const Vec3 place = tip(t_s);
    for (int i = 0; i < 3; ++i) sample.set(static_cast<std::size_t>(i), place[i]);
    sample.device_ns = static_cast<std::int64_t>(t_s * 1e9);
    sample.tool = at(t_s).motion.tool;
    if (with_line) sample.line = static_cast<std::int32_t>(at(t_s).motion.source.line);
    return sample;
  }
  const std::vector<TimedMotion>& list() const { return times_.list; }

 private:
  MotionTimes times_;
};

}  // namespace kerf
