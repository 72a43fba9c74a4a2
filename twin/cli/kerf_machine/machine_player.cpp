#include "twin/cli/kerf_machine/machine_player.h"

#include <algorithm>
#include <cmath>

#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// A piece as the motion whose way it is.
Motion motion_of(const PathPiece& piece) {
  Motion motion;
  motion.kind = piece.curved ? MotionKind::kArc : MotionKind::kFeed;
  motion.from_mm = piece.from_mm;
  motion.to_mm = piece.to_mm;
  motion.arc = piece.arc;
  return motion;
}

}  // namespace

MachinePlayer::MachinePlayer(StepFeed& feed, ServedFrame frame) : feed_(feed), frame_(frame) {}

void MachinePlayer::prepare(const std::stop_token& stop) {
  feed_.wait(stop);
  load();
}

StepFeed::Next MachinePlayer::load() {
  if (next_ < batch_.steps.size()) return StepFeed::Next::kBatch;
  const std::uint64_t pass = batch_.pass;
  const StepFeed::Next found = feed_.next(batch_);
  if (found != StepFeed::Next::kBatch) return found;
  next_ = 0;
  if (!any_ || batch_.pass != pass) begin_pass();
  any_ = true;
  return found;
}

void MachinePlayer::begin_pass() {
  const double angle = batch_.frame.rotation_deg * kPi / 180;
  turn_cos_ = std::cos(angle);
  turn_sin_ = std::sin(angle);
  bool found = false;
  const Pose start = first_pose(found);
  if (any_) {
    plan_return(found ? start : state_.position);
    return;
  }
  if (found) state_.position = start;
  const MachineStep& first = batch_.steps.front();
  if (first.kind != MotionKind::kToolChange) state_.tool = first.tool;
  state_.tool_offset_z_mm = first.applied_offset_z_mm;
}

/// Where the first step that moves begins.
MachinePlayer::Pose MachinePlayer::first_pose(bool& found) const {
  for (const MachineStep& s : batch_.steps) {
    if (!s.moves) continue;
    found = true;
    return served(batch_.pieces[s.first_piece].from_mm, s.tool_offset_mm, s.from_abc_deg);
  }
  return {};
}

void MachinePlayer::plan_return(const Pose& to) {
  returning_ = true;
  return_from_ = state_.position;
  return_start_s_ = last_end_s_;
  const double top = std::max(return_from_[2], to[2]);
  legs_[0].to = return_from_;
  legs_[0].to[2] = top;
  legs_[1].to = to;
  legs_[1].to[2] = top;
  legs_[2].to = to;
  double time = return_start_s_;
  Pose from = return_from_;
  for (Leg& leg : legs_) {
    double square = 0;
    for (std::size_t i = 0; i < kSimulatedAxes; ++i) square += std::pow(leg.to[i] - from[i], 2);
    leg.end_s = time += std::sqrt(square) / kReturnSpeed;
    from = leg.to;
  }
  offset_s_ = time;
}

bool MachinePlayer::advance(double seconds) {
  time_s_ += seconds;
  while (true) {
    const StepFeed::Next found = load();
    if (found != StepFeed::Next::kBatch) {
      time_s_ = last_end_s_;
      state_.line = 0;
      return found != StepFeed::Next::kEnd;
    }
    const double into = time_s_ - offset_s_ - step().start_s;
    if (into < 0) {
      stand_between();
      return true;
    }
    if (!begun_) begin_step();
    if (into < step().duration_s) {
      if (step().moves) move_to(step().way.way_of(into / step().duration_s));
      return true;
    }
    end_step();
  }
}

/// Between two steps nothing moves, but for the way back between two passes.
void MachinePlayer::stand_between() {
  state_.line = 0;
  if (!returning_) return;
  Pose from = return_from_;
  double start = return_start_s_;
  for (const Leg& leg : legs_) {
    if (time_s_ < leg.end_s) {
      const double fraction = (time_s_ - start) / (leg.end_s - start);
      for (std::size_t i = 0; i < kSimulatedAxes; ++i) {
        state_.position[i] = from[i] + fraction * (leg.to[i] - from[i]);
      }
      return;
    }
    from = leg.to;
    start = leg.end_s;
  }
  state_.position = from;
  returning_ = false;
}

void MachinePlayer::begin_step() {
  begun_ = true;
  if (returning_) state_.position = legs_.back().to;
  returning_ = false;
  const MachineStep& s = step();
  state_.spindle_rpm = s.spindle_rpm;
  state_.line = s.moves ? s.line : 0;
  if (s.kind == MotionKind::kToolChange) return;
  state_.tool = s.tool;
  state_.tool_offset_z_mm = s.applied_offset_z_mm;
  lengths_.clear();
  double sum = 0;
  for (std::uint32_t i = 0; i < s.piece_count; ++i) {
    sum += path_length_mm(motion_of(batch_.pieces[s.first_piece + i]));
    lengths_.push_back(sum);
  }
}

void MachinePlayer::move_to(double fraction) {
  const MachineStep& s = step();
  const double way = fraction * lengths_.back();
  // The last piece where the whole has no length: a step that only turns.
  std::size_t i = 0;
  while (i + 1 < lengths_.size() && lengths_[i] <= way) ++i;
  const double before = i == 0 ? 0 : lengths_[i - 1];
  const double length = lengths_[i] - before;
  const double part = length > 0 ? std::clamp((way - before) / length, 0.0, 1.0) : 1.0;
  std::array<double, 3> abc{};
  for (std::size_t k = 0; k < 3; ++k) {
    abc[k] = s.from_abc_deg[k] + fraction * (s.to_abc_deg[k] - s.from_abc_deg[k]);
  }
  const Vec3 tip = point_at(motion_of(batch_.pieces[s.first_piece + i]), part);
  state_.position = served(tip, s.tool_offset_mm, abc);
}

void MachinePlayer::end_step() {
  const MachineStep& s = step();
  state_.tool = s.tool;
  if (s.moves) {
    const PathPiece& last = batch_.pieces[s.first_piece + s.piece_count - 1];
    state_.position = served(last.to_mm, s.tool_offset_mm, s.to_abc_deg);
  }
  last_end_s_ = offset_s_ + s.start_s + s.duration_s;
  begun_ = false;
  ++next_;
}

MachinePlayer::Pose MachinePlayer::served(const Vec3& tip_mm, const Vec3& tool_offset_mm,
                                          const std::array<double, 3>& abc_deg) const {
  Pose pose = {tip_mm.x, tip_mm.y, tip_mm.z, abc_deg[0], abc_deg[1], abc_deg[2]};
  if (frame_ == ServedFrame::kWorkpiece) return pose;
  const WorkpieceFrame& work = batch_.frame;
  const Vec3 p = tip_mm + work.g92_mm;
  pose[0] = turn_cos_ * p.x - turn_sin_ * p.y + work.g5x_mm.x + tool_offset_mm.x;
  pose[1] = turn_sin_ * p.x + turn_cos_ * p.y + work.g5x_mm.y + tool_offset_mm.y;
  pose[2] = p.z + work.g5x_mm.z + tool_offset_mm.z;
  for (std::size_t i = 0; i < 3; ++i) pose[3 + i] += work.offset_abc_deg[i];
  return pose;
}

}  // namespace kerf
