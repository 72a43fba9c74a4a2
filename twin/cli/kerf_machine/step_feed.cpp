#include "twin/cli/kerf_machine/step_feed.h"

#include <algorithm>
#include <utility>

#include "interp_bridge/motion_kinds.h"

namespace kerf {
namespace {

double signed_rpm(const Motion& motion) {
  switch (motion.spindle) {
    case SpindleState::kStopped:
      return 0;
    case SpindleState::kClockwise:
      return motion.spindle_rpm;
    case SpindleState::kCounterclockwise:
      return -motion.spindle_rpm;
  }
  return 0;
}

PathPiece whole_way(const Motion& motion) {
  PathPiece piece;
  piece.curved = motion.kind == MotionKind::kArc && motion.start_known;
  piece.from_mm = motion.from_mm;
  piece.to_mm = motion.to_mm;
  piece.arc = motion.arc;
  return piece;
}

}  // namespace

StepFeed::StepFeed(StepFeedOptions options, std::unique_ptr<Program> program)
    : options_(std::move(options)), program_(std::move(program)) {
  options_.timeline.planner.with_path = true;
  thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

StepFeed::~StepFeed() {
  thread_.request_stop();
  thread_.join();
}

void StepFeed::work(const std::stop_token& stop) {
  stop_ = stop;
  bool again = true;
  while (again && !stop.stop_requested()) {
    again = run_pass(stop) && options_.repeat;
    if (!again || stop.stop_requested()) break;
    ++filling_.pass;
    program_ = Program::open(options_.program, diagnostics_);
    again = program_ != nullptr;
  }
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

/// True: the program went well, and there is something to repeat.
bool StepFeed::run_pass(const std::stop_token& stop) {
  Timeline timeline(options_.timeline, *this);
  Diagnostics said;
  program_->run(
      [&](std::span<const Motion> motions) {
        filling_.frame = program_->workpiece_frame();
        for (const Motion& motion : motions) timeline.push(motion);
        return hand_over(stop);
      },
      stop, said);
  timeline.finish();
  hand_over(stop);
  const bool went_well = !has_error(said);
  // The same remarks in each pass are one remark.
  if (filling_.pass == 0 || !went_well) {
    diagnostics_.insert(diagnostics_.end(), said.begin(), said.end());
  }
  return went_well && timeline.clock_s() > 0;
}

void StepFeed::step(const Motion& motion, const TimedStep& timed, std::span<const PathPiece> path) {
  if (filling_.steps.size() >= kBatchSteps && !hand_over(stop_)) return;
  MachineStep& step = filling_.steps.emplace_back();
  step.start_s = timed.start_s;
  step.duration_s = timed.duration_s;
  step.way = timed.way;
  step.kind = motion.kind;
  step.moves = is_move(motion);
  step.line = motion.source.line;
  step.tool = motion.tool;
  step.spindle_rpm = signed_rpm(motion);
  step.tool_offset_mm = motion.tool_offset_mm;
  step.applied_offset_z_mm = motion.tool_offset_mm.z + motion.length.tip_shift_mm.z;
  step.from_abc_deg = motion.start_known ? motion.from_abc_deg : motion.to_abc_deg;
  step.to_abc_deg = motion.to_abc_deg;
  step.first_piece = static_cast<std::uint32_t>(filling_.pieces.size());
  if (step.moves && path.empty()) {
    filling_.pieces.push_back(whole_way(motion));
  } else if (step.moves) {
    filling_.pieces.insert(filling_.pieces.end(), path.begin(), path.end());
  }
  step.piece_count = static_cast<std::uint32_t>(filling_.pieces.size()) - step.first_piece;
}

/// Waits for room. False: stopped.
bool StepFeed::hand_over(const std::stop_token& stop) {
  if (filling_.steps.empty()) return !stop.stop_requested();
  std::unique_lock lock(mutex_);
  if (!changed_.wait(lock, stop, [&] { return full_.size() < kMaxBatches; })) return false;
  StepBatch empty;
  if (!spare_.empty()) {
    empty = std::move(spare_.back());
    spare_.pop_back();
  }
  empty.clear();
  empty.frame = filling_.frame;
  empty.pass = filling_.pass;
  full_.push_back(std::exchange(filling_, std::move(empty)));
  changed_.notify_all();
  return true;
}

void StepFeed::wait(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, stop, [&] { return ended_ || !full_.empty(); });
}

StepFeed::Next StepFeed::next(StepBatch& batch) {
  const std::lock_guard lock(mutex_);
  if (full_.empty()) return ended_ ? Next::kEnd : Next::kNotYet;
  spare_.push_back(std::move(batch));
  batch = std::move(full_.front());
  full_.pop_front();
  changed_.notify_all();
  return Next::kBatch;
}

}  // namespace kerf
