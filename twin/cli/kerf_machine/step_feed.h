// twin/cli/kerf_machine/step_feed.h - a program as steps in time, read ahead by a thread of its
// own.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/program.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// What the machine does from start_s to start_s + duration_s of its program's time.
struct MachineStep {
  double start_s = 0;
  double duration_s = 0;
  WayInTime way;
  MotionKind kind = MotionKind::kDwell;
  bool moves = false;  ///< then it has a path; other steps have no place
  std::uint32_t line = 0;
  int tool = 0;
  double spindle_rpm = 0;  ///< negative: counterclockwise
  Vec3 tool_offset_mm{0};
  double applied_offset_z_mm = 0;  ///< what the controller takes for it
  std::array<double, 3> from_abc_deg{};
  std::array<double, 3> to_abc_deg{};
  std::uint32_t first_piece = 0;  ///< in StepBatch::pieces
  std::uint32_t piece_count = 0;
};

/// Steps in program order with their paths. A step that the planner gives no path of its own (one
/// that takes no time, one that only turns) has the programmed one.
struct StepBatch {
  std::vector<MachineStep> steps;
  std::vector<PathPiece> pieces;
  WorkpieceFrame frame;
  std::uint64_t pass = 0;  ///< 0, then 1, .. where the program is repeated; times begin anew

  void clear() {
    steps.clear();
    pieces.clear();
  }
};

struct StepFeedOptions {
  ProgramOptions program;
  TimelineOptions timeline;  ///< planner.with_path is set here
  bool repeat = false;
};

/// Interprets and plans ahead of the machine: at most kMaxBatches of about kBatchSteps steps wait,
/// so that memory does not grow with the program, and a program that never ends is one that the
/// machine runs for ever. Batches are used again.
class StepFeed : private StepSink {
 public:
  static constexpr std::size_t kBatchSteps = 256;
  static constexpr std::size_t kMaxBatches = 64;
  enum class Next : std::uint8_t {
    kBatch,   ///< the next batch is there
    kNotYet,  ///< the interpreter has not come so far
    kEnd,     ///< the program is over; diagnostics() say how it went
  };

  /// `program` has been opened with options.program, and is the first pass.
  StepFeed(StepFeedOptions options, std::unique_ptr<Program> program);
  /// Stops the interpreter.
  ~StepFeed() override;

  /// Waits until next() has an answer other than kNotYet, or `stop` is requested.
  void wait(const std::stop_token& stop);
  /// Never waits. Swaps the batch in.
  Next next(StepBatch& batch);

  /// After kEnd: what the interpreter had to say.
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  void work(const std::stop_token& stop);
  bool run_pass(const std::stop_token& stop);
  void step(const Motion& motion, const TimedStep& timed, std::span<const PathPiece> path) override;
  bool hand_over(const std::stop_token& stop);

  StepFeedOptions options_;
  std::unique_ptr<Program> program_;
  Diagnostics diagnostics_;
  StepBatch filling_;
  std::stop_token stop_;  ///< of the thread, for step()

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<StepBatch> full_;
  std::vector<StepBatch> spare_;
  bool ended_ = false;
  std::jthread thread_;
};

}  // namespace kerf
