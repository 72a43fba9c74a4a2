// A punch that is watched: LiveCutter's strokes.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "twin/live/live_cutter.h"
#include "twin/motion_geometry.h"

namespace kerf {
namespace {

/// As the follower has it: what is not on the path is done without moving.
bool is_on_path(const Motion& m) {
  const bool moves = is_traverse(m) || m.kind == MotionKind::kProbe || is_feed(m);
  if (!moves || !m.start_known) return false;
  const bool turns = m.kind == MotionKind::kArc && m.arc.sweep_rad != 0;
  return turns || m.from_mm != m.to_mm || m.from_abc_deg != m.to_abc_deg ||
         m.from_uvw_mm != m.to_uvw_mm;
}

}  // namespace

/// `seen`: the way from the sample before.
void LiveCutter::punch(const Sighting& now, const FollowedPoint& point, bool seen) {
  const bool along = seen && point.on_path && was_on_path_;
  if (point.on_path) punch_program(point, along);
  const int tool = std::max(0, now.tool >= 0 ? now.tool : program_tool_);
  const std::span<const PunchHit> hits =
      strokes_->take(sample_, now.place, tool, before_.has_value() && !seen);
  if (along || point.on_path) return;
  note_unseen_trigger(now);
  if (hits.empty() && !strokes_->drags()) return;
  Motion motion;
  motion.tool = tool;
  motion.source = {0, sample_.line > 0 ? static_cast<std::uint32_t>(sample_.line) : 0};
  motion.from_mm = motion.to_mm = now.place.tip_mm;
  motion.from_abc_deg = motion.to_abc_deg = now.place.abc_deg;
  TimedStep step;
  step.start_s = t_s_;
  if (hits.empty()) {
    stage_.punch()->note_dragging(motion, step);
  } else {
    stage_.punch()->take_seen(motion, step, hits);
    guard_stale_ = true;
  }
}

/// Number of the first motion whose strokes the machine has been seen at, where the way before has
/// not been: one that is first seen where a motion begins has what does not move still before it.
std::uint64_t LiveCutter::seen_from(const FollowedPoint& point) const {
  const auto motion_at = [&](std::uint64_t number) -> const Motion& {
    return ahead_->motions()[static_cast<std::size_t>(number - ahead_->forgotten())].motion;
  };
  std::uint64_t number = point.motion;
  const double on_it_mm = point.share * path_length_mm(motion_at(number));
  if (on_it_mm > options_.follow.tolerance_mm) return number;
  while (number > punched_ && !is_on_path(motion_at(number - 1))) --number;
  return number;
}

/// `along`: the machine has come along the path since the sample before. The strokes of a motion
/// are cut in one call, when it is done: in several the sheet has the same shape, and other bits.
void LiveCutter::punch_program(const FollowedPoint& point, bool along) {
  // A machine that stands at the end of a motion has been there.
  if (point.motion < punched_) return;
  assert(punched_ >= ahead_->forgotten());
  const bool before = std::exchange(struck_before_, false);
  along |= before;
  const std::uint64_t from = along ? punched_ : seen_from(point);
  const bool goes_on = point.motion == punched_;
  if (!along) punch_seen_part();
  for (; punched_ < point.motion; ++punched_) {
    const std::size_t at = static_cast<std::size_t>(punched_ - ahead_->forgotten());
    log_.set_muted(before);  // until the motion has been taken
    punch_motion(ahead_->motions()[at].motion, 1, punched_ >= from);
  }
  ahead_->forget(static_cast<std::size_t>(punched_ - ahead_->forgotten()));
  if (point.share > 0 && point.share < 1 && sample_.tool >= 0) {
    real_tool_ = sample_.tool;
    real_program_tool_ = point.tool;
  }
  if (!goes_on) seen_share_ = 0;
  log_.set_muted(false);
  if (!along && point.share > 0) {
    punch_motion(ahead_->motions().front().motion, point.share, false);
  }
  seen_share_ = along ? point.share : 0;
  if (point.share < 1) return;
  if (along) punch_motion(ahead_->motions().front().motion, 1, true);
  seen_share_ = 0;
  ++punched_;
  ahead_->forget(1);
}

/// What the machine has been seen to do of the motion that it was on.
void LiveCutter::punch_seen_part() {
  if (seen_share_ <= 0 || ahead_->motions().empty()) return;
  punch_motion(ahead_->motions().front().motion, seen_share_, true);
  seen_share_ = 0;
}

/// With the tool that the machine really has, until the program changes it.
void LiveCutter::punch_motion(Motion motion, double share, bool seen) {
  if (real_tool_ >= 0 && motion.tool == real_program_tool_) motion.tool = real_tool_;
  TimedStep step;
  step.start_s = t_s_;
  step.length_mm = path_length_mm(motion);
  step.programmed_mm_per_min = step.allowed_mm_per_min = motion.feed_mm_per_min;
  if (share < 1 || !seen) {
    stage_.punch()->take_part(motion, step, share, seen);
  } else {
    stage_.take_timed(motion, step);
  }
}

/// The path has been passed to its end: what follows does not move.
void LiveCutter::punch_rest() {
  punch_seen_part();
  if (!follower_.found() || !follower_.passed_all() || !ahead_->complete() || !was_on_path_) return;
  for (const PlannedMotion& planned : ahead_->motions()) punch_motion(planned.motion, 1, true);
  ahead_->forget(ahead_->motions().size());
}

/// Once.
void LiveCutter::note_unseen_trigger(const Sighting& now) {
  if (ahead_ || beam_told_ || strokes_->is_told()) return;
  beam_told_ = true;
  Finding finding =
      finding_of(FindingId::kNoHit, Severity::kWarning, now.t_s, now.place.tip_mm, now.tool);
  finding.text = fmt::format(
      "nothing tells when the punch strikes: the source has {} (punch.trigger in {}), and no "
      "program is followed (--program); nothing is punched until it does",
      strokes_->missing(), options_.turret->path);
  log_.add(std::move(finding));
}

}  // namespace kerf
