#include "twin/live/punch_follower.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "interp_bridge/motion_kinds.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// As the follower has it: what is not on the path is done without moving.
bool is_on_path(const Motion& m) { return is_move(m) && m.start_known && !stands_still(m); }

}  // namespace

PunchFollower::PunchFollower(const LiveCutOptions& options, PathMatcher& matcher, CutStage& stage,
                             MachineWatch& watch, FindingLog& log)
    : options_(options),
      matcher_(matcher),
      stage_(stage),
      watch_(watch),
      log_(log),
      strokes_(options.process->turret()) {}

bool PunchFollower::take(const Reading& now, const PathMatch& point, Way way) {
  t_s_ = now.t_s;
  const bool along = way == Way::kAlongPath;
  if (point.on_path) punch_program(point, now.sample.tool, along);
  const int tool = std::max(0, now.tool >= 0 ? now.tool : matcher_.program_tool());
  const std::span<const PunchHit> hits =
      strokes_.take(now.sample, now.place, tool, way == Way::kUnseen);
  if (point.on_path) return false;
  if (!matcher_.program()) watch_.note_unseen_trigger(now, strokes_);
  if (hits.empty() && !strokes_.drags()) return false;
  Motion motion;
  motion.tool = tool;
  const int line = now.sample.line;
  motion.source = {0, line > 0 ? static_cast<std::uint32_t>(line) : 0};
  motion.from_mm = motion.to_mm = now.place.tip_mm;
  motion.from_abc_deg = motion.to_abc_deg = now.place.abc_deg;
  TimedStep step;
  step.start_s = t_s_;
  if (hits.empty()) {
    stage_.strokes()->note_dragging(motion, step);
    return false;
  }
  stage_.strokes()->take_seen(motion, step, hits);
  return true;
}

/// Number of the first motion whose strokes the machine has been seen at, where the way before has
/// not been: one that is first seen where a motion begins has what does not move still before it.
std::uint64_t PunchFollower::seen_from(const PathMatch& point) const {
  const ProgramAhead& ahead = *matcher_.program();
  const auto motion_at = [&](std::uint64_t number) -> const Motion& {
    return ahead.motions()[static_cast<std::size_t>(number - ahead.forgotten())].motion;
  };
  std::uint64_t number = point.motion;
  const double on_it_mm = point.share * path_length_mm(motion_at(number));
  if (on_it_mm > options_.follow.tolerance_mm) return number;
  while (number > punched_ && !is_on_path(motion_at(number - 1))) --number;
  return number;
}

/// `along`: the machine has come along the path since the sample before. The strokes of a motion
/// are cut in one call, when it is done: in several the sheet has the same shape, and other bits.
void PunchFollower::punch_program(const PathMatch& point, int real_tool, bool along) {
  ProgramAhead& ahead = *matcher_.program();
  // A machine that stands at the end of a motion has been there.
  if (point.motion < punched_) return;
  assert(punched_ >= ahead.forgotten());
  const bool before = std::exchange(struck_before_, false);
  along |= before;
  const std::uint64_t from = along ? punched_ : seen_from(point);
  const bool goes_on = point.motion == punched_;
  if (!along) punch_seen_part();
  for (; punched_ < point.motion; ++punched_) {
    const std::size_t at = static_cast<std::size_t>(punched_ - ahead.forgotten());
    log_.set_muted(before);  // until the motion has been taken
    punch_motion(ahead.motions()[at].motion, 1, punched_ >= from);
  }
  ahead.forget(static_cast<std::size_t>(punched_ - ahead.forgotten()));
  if (point.share > 0 && point.share < 1 && real_tool >= 0) {
    real_tool_ = real_tool;
    real_program_tool_ = point.tool;
  }
  if (!goes_on) seen_share_ = 0;
  log_.set_muted(false);
  if (!along && point.share > 0) {
    punch_motion(ahead.motions().front().motion, point.share, false);
  }
  seen_share_ = along ? point.share : 0;
  if (point.share < 1) return;
  if (along) punch_motion(ahead.motions().front().motion, 1, true);
  seen_share_ = 0;
  ++punched_;
  ahead.forget(1);
}

/// What the machine has been seen to do of the motion that it was on.
void PunchFollower::punch_seen_part() {
  const ProgramAhead& ahead = *matcher_.program();
  if (seen_share_ <= 0 || ahead.motions().empty()) return;
  punch_motion(ahead.motions().front().motion, seen_share_, true);
  seen_share_ = 0;
}

/// With the tool that the machine really has, until the program changes it.
void PunchFollower::punch_motion(Motion motion, double share, bool seen) {
  if (real_tool_ >= 0 && motion.tool == real_program_tool_) motion.tool = real_tool_;
  TimedStep step;
  step.start_s = t_s_;
  step.length_mm = path_length_mm(motion);
  step.programmed_mm_per_min = step.allowed_mm_per_min = motion.feed_mm_per_min;
  if (share < 1 || !seen) {
    stage_.strokes()->take_part(motion, step, share, seen);
  } else {
    stage_.take_timed(motion, step);
  }
}

/// The path has been passed to its end: what follows does not move.
void PunchFollower::finish(bool was_on_path, double t_s) {
  if (!matcher_.program()) return;
  t_s_ = t_s;
  ProgramAhead& ahead = *matcher_.program();
  const PathFollower& follower = matcher_.follower();
  punch_seen_part();
  if (!follower.found() || !follower.passed_all() || !ahead.complete() || !was_on_path) return;
  for (const PlannedMotion& planned : ahead.motions()) punch_motion(planned.motion, 1, true);
  ahead.forget(ahead.motions().size());
}

}  // namespace kerf
