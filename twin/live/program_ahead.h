// twin/live/program_ahead.h - the program that a machine runs, read and planned a little ahead of
// it.
#pragma once

#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "interp_bridge/program.h"
#include "twin/live/path_follower.h"
#include "twin/machine/kinematics/switched_motions.h"
#include "twin/machine/timeline.h"
#include "twin/program/batch_queue.h"
#include "twin/program/material_handover.h"

namespace kerf {

/// A motion with its time by the plan, and what the machine makes of it (StepSink).
struct PlannedMotion {
  Motion motion;
  double start_s = 0;
  double end_s = 0;
  TimedStep step;
  std::vector<PathPiece> path;
};

/// Interprets in a thread of its own, which waits when it is far ahead; plans in the caller's, and
/// appends the path to a follower. Memory does not grow with the program, but for what a
/// SharedReading keeps of it.
class ProgramAhead : private StepSink {
 public:
  /// `follower` must outlive it.
  ProgramAhead(std::unique_ptr<Program> program, const TimelineOptions& options,
               PathFollower& follower);
  ~ProgramAhead();
  ProgramAhead(const ProgramAhead&) = delete;
  ProgramAhead& operator=(const ProgramAhead&) = delete;

  /// Where the workpiece lies in the machine, by the program's first work offset. Waits for the
  /// interpreter's first motions. Nothing if the program has none that moves.
  std::optional<WorkpieceFrame> wait_for_frame();
  /// Reads until `until_s` of program time is planned. `wait`: as long as it takes; else what is
  /// there now.
  void read_until(double until_s, bool wait);
  /// The program has been read and planned to its end.
  bool complete() const { return complete_; }

  /// Line of the move by which the machine comes from wherever it was, if the program begins with
  /// one; -1: none has been planned.
  int approach_line() const { return approach_line_; }

  /// Planned, and not yet forgotten, in order.
  const std::deque<PlannedMotion>& motions() const { return motions_; }
  /// Number of motions that were forgotten: motions()[i] is number forgotten() + i of the program.
  std::uint64_t forgotten() const { return forgotten_; }
  void forget_before(double program_s);
  void forget(std::size_t count);

  /// Ends the interpreter, if it still runs. Then what it said is in summary() and diagnostics().
  void stop();
  const ProgramSummary& summary() const { return summary_; }
  const Diagnostics& diagnostics() const { return diagnostics_; }
  /// Of a torch program, all that the motions so far name. True: `materials` has more of them now.
  bool take_materials(std::vector<TorchMaterial>& materials) { return materials_.take(materials); }
  /// Files that the motions name so far.
  std::vector<std::string> files() const;

 private:
  void step(const Motion& motion, const TimedStep& timed, std::span<const PathPiece> path) override;
  bool plan_one_batch(bool wait);

  std::unique_ptr<Program> program_;
  PathFollower& follower_;
  Timeline timeline_;
  SwitchedMotions switched_;  ///< of thread_
  BatchQueue queue_;
  MaterialHandover materials_;
  std::vector<TorchMaterial> planned_materials_;  ///< that the timeline knows
  std::span<const Motion> batch_;                 ///< of queue_
  std::deque<PlannedMotion> motions_;
  std::uint64_t forgotten_ = 0;
  double planned_s_ = 0;
  bool complete_ = false;
  bool has_moved_ = false;
  int approach_line_ = -1;
  mutable std::mutex mutex_;  // of the two that follow
  std::optional<WorkpieceFrame> frame_;
  std::vector<std::string> files_;
  std::stop_source stop_;
  ProgramSummary summary_;
  Diagnostics diagnostics_;
  std::exception_ptr failure_;  ///< of the thread; after queue_ is closed
  std::thread thread_;
};

}  // namespace kerf
