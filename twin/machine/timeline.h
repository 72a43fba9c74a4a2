// twin/machine/timeline.h - when each motion starts and how long it takes, and the sums of a
// program.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/machine_limits.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/timing/planner.h"
#include "twin/machine/program_holds.h"

namespace kerf {

struct MachineKinematics;

struct TimelineOptions {
  MachineLimits limits = MachineLimits::small_mill();
  bool limits_known = false;  ///< of the user's machine; false: assumed
  PlannerOptions planner;     ///< with_path: the steps carry the planned path
  /// How the machine turns the tool or the workpiece; null: A, B and C turn nothing.
  std::shared_ptr<const MachineKinematics> kinematics;
  bool kinematics_known = false;  ///< those of the user's machine; false: assumed
  /// By the letter of the axis that the joint moves; no limits without an INI.
  std::array<AxisLimits, kAxisCount> joint_limits{};
  /// What the machine stands for beyond its program's words: ProcessPlan::holds().
  MakeHolds holds;
};

/// Sums over the motions of a program.
struct MotionTotals {
  std::uint64_t moves = 0;       ///< motions that move: traverses, feeds, arcs, threads, probes
  std::uint64_t feed_moves = 0;  ///< feeds, arcs, threads, probes
  std::uint64_t traverse_moves = 0;
  std::uint64_t arcs = 0;
  std::uint64_t moves_without_feed =
      0;  ///< feed moves with no feed rate in force: counted with no time
  double feed_mm = 0;
  double traverse_mm = 0;
  double duration_s = 0;
  std::optional<HeldTime>
      held;  ///< of that; absent: nothing was asked for (TimelineOptions::holds)
};

/// One motion in time.
struct TimedStep {
  double start_s = 0;
  double duration_s = 0;
  double held_before_s = 0;          ///< the machine stood so long before (ProgramHolds)
  double length_mm = 0;              ///< as programmed
  double programmed_mm_per_min = 0;  ///< of a feed move; 0: no feed rate in force
  double allowed_mm_per_min = 0;     ///< by the axes, along this motion
  double peak_mm_per_min = 0;        ///< the greatest speed that is reached; 0: not known

  WayInTime way;  ///< how its way goes in its time
  /// When this share of the way is done.
  double time_at(double share) const { return start_s + way.time_of(share) * duration_s; }
  /// The share of the way that is done then.
  double way_at(double time_s) const {
    return duration_s > 0 ? way.way_of((time_s - start_s) / duration_s) : 1;
  }
};

/// Receives the motions with their times.
class StepSink {
 public:
  virtual ~StepSink() = default;
  /// In program order. `path`: what the machine really runs, where it was asked for
  /// (PlannerOptions::with_path) and the motion moves; valid during the call.
  virtual void step(const Motion& motion, const TimedStep& timed,
                    std::span<const PathPiece> path) = 0;
};

/// Times of motions under a machine's limits (TrajectoryPlanner), and their sums. A motion's time
/// depends on those behind it, so steps come out some motions later than they go in; after finish()
/// none is missing. The motions wait in a ring that is used again.
class Timeline : private MotionPlanSink {
 public:
  /// `sink` must outlive the timeline.
  Timeline(const TimelineOptions& options, StepSink& sink);

  void push(const Motion& motion);
  void finish();
  /// Of a torch program, all that the motions name from here on.
  void set_materials(std::span<const TorchMaterial> materials) {
    if (holds_) holds_->set_materials(materials);
  }

  /// Of the steps that have come out.
  const MotionTotals& totals() const { return totals_; }
  /// Sums begin anew, the clock goes on. From within a step: that one is the first in the sums.
  void begin_totals() {
    totals_ = {};
    totals_from_s_ = -1;
  }
  double clock_s() const { return clock_s_; }  ///< program time after the last step
  /// For the report, one sentence.
  std::string time_model() const {
    return planner_.time_model() + (holds_ ? holds_->text() : std::string());
  }

 private:
  struct Waiting {
    Motion motion;
    HeldTime before, held;  ///< before its time, and else
    bool open = false;      ///< its end is not the planner's: the machine stands, it goes on
  };
  void timed(const MotionTiming& timing) override;
  Waiting& wait(const Motion& motion);
  void push_held(Waiting& waiting);
  void push_row(Waiting& waiting, std::span<const double> row);
  void close(double start_s);
  void emit(const MotionTiming& timing);
  void path(const PathPiece& piece) override { path_.push_back(piece); }
  void count(const Motion& motion, const TimedStep& step);

  StepSink& sink_;
  TrajectoryPlanner planner_;
  MotionTotals totals_;
  double clock_s_ = 0;
  double totals_from_s_ = 0;      ///< where the sums begin; negative: with the next step
  std::vector<Waiting> waiting_;  ///< ring; its size is a power of two
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::vector<PathPiece> path_;
  std::unique_ptr<ProgramHolds> holds_;      ///< null: none
  std::optional<MotionTiming> open_timing_;  ///< of the open one's first part
};

}  // namespace kerf
