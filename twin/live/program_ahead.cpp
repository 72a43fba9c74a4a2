#include "twin/live/program_ahead.h"

#include <algorithm>
#include <utility>

namespace kerf {
namespace {

/// A program whose moves take no time (no feed) would be read whole.
constexpr std::size_t kMostMotions = 200'000;

bool moves(std::span<const Motion> motions) {
  return std::any_of(motions.begin(), motions.end(), [](const Motion& m) {
    return m.kind != MotionKind::kToolChange && m.kind != MotionKind::kDwell &&
           m.kind != MotionKind::kStop && m.kind != MotionKind::kProgramEnd;
  });
}

}  // namespace

ProgramAhead::ProgramAhead(std::unique_ptr<Program> program, const TimelineOptions& options,
                           PathFollower& follower)
    : program_(std::move(program)),
      follower_(follower),
      timeline_(options, *this),
      switched_(options.kinematics) {
  thread_ = std::thread([this] {
    const MotionSink sink = [this](std::span<const Motion> motions) {
      {
        const std::lock_guard lock(mutex_);
        if (files_.size() != program_->files().size()) files_ = program_->files();
        if (!frame_ && moves(motions)) frame_ = program_->workpiece_frame();
      }
      materials_.put(program_->materials());
      return queue_.push(switched_.follow(motions, program_->workpiece_frame()));
    };
    try {
      summary_ = program_->run(sink, stop_.get_token(), diagnostics_);
    } catch (...) {
      failure_ = std::current_exception();
    }
    queue_.close();
  });
}

ProgramAhead::~ProgramAhead() { stop(); }

void ProgramAhead::stop() {
  stop_.request_stop();
  queue_.close();
  if (thread_.joinable()) thread_.join();
}

std::vector<std::string> ProgramAhead::files() const {
  const std::lock_guard lock(mutex_);
  return files_;
}

std::optional<WorkpieceFrame> ProgramAhead::wait_for_frame() {
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      if (frame_) return frame_;
    }
    if (!plan_one_batch(true)) return std::nullopt;
  }
}

/// False: there is none now, or none any more.
bool ProgramAhead::plan_one_batch(bool wait) {
  if (complete_) return false;
  const bool got = wait ? queue_.pop(batch_) : queue_.try_pop(batch_);
  if (got) {
    if (materials_.take(planned_materials_)) timeline_.set_materials(planned_materials_);
    for (const Motion& motion : batch_) timeline_.push(motion);
    return true;
  }
  if (queue_.drained()) {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    timeline_.finish();
    complete_ = true;
  }
  return false;
}

void ProgramAhead::read_until(double until_s, bool wait) {
  while (planned_s_ < until_s && motions_.size() < kMostMotions) {
    if (!plan_one_batch(wait)) return;
  }
}

void ProgramAhead::forget_before(double program_s) {
  while (!motions_.empty() && motions_.front().end_s < program_s) {
    motions_.pop_front();
    ++forgotten_;
  }
}

void ProgramAhead::forget(std::size_t count) {
  motions_.erase(motions_.begin(), motions_.begin() + static_cast<std::ptrdiff_t>(count));
  forgotten_ += count;
}

void ProgramAhead::step(const Motion& motion, const TimedStep& timed,
                        std::span<const PathPiece> path) {
  planned_s_ = timed.start_s + timed.duration_s;
  if (!has_moved_ && moves({&motion, 1})) {
    has_moved_ = true;
    if (!motion.start_known) approach_line_ = static_cast<int>(motion.source.line);
  }
  motions_.push_back(
      {motion, timed.start_s, planned_s_, timed, std::vector<PathPiece>(path.begin(), path.end())});
  follower_.append(motion, timed, path);
}

}  // namespace kerf
