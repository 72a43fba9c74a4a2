// A machine that is found in its program for the first time: LiveCutter's beginning.

#include "twin/live/live_cutter.h"
#include "twin/motion_geometry.h"
#include "twin/motion_nearest.h"

namespace kerf {
namespace {

/// After a search of the whole program that found nothing, the next one comes after so many times
/// as long.
constexpr double kJoinAgain = 4;

}  // namespace

PathFollower::Drive LiveCutter::drive() {
  return [this](const PathFollower::DrivenPart& part) { driven_.push_back(part); };
}

/// Where on the path the machine is, that has not been on it yet. Nothing of what lies before has
/// been seen: it is in the workpiece already, unless the machine has been watched for long enough
/// to have come there from the program's beginning.
FollowedPoint LiveCutter::find(const FollowedPlace& place) {
  const double begin_s = follower_.program_s();
  watched_s_ += place.elapsed_s;
  FollowedPoint point = follower_.follow(place, drive());
  bool late = false;
  if (point.on_path) {
    const double watched_s = options_.follow.haste * watched_s_ + options_.follow.slack_s;
    late = point.program_s - begin_s > watched_s;
  } else if (lost_sight_s_ >= join_after_s_) {
    join_after_s_ *= kJoinAgain;
    const std::optional<std::uint64_t> motion = motion_at(place);
    if (!motion) return point;
    pass(*motion);
    point = follower_.follow(place, drive());
    late = true;
  }
  if (late && options_.seen_before) {
    guard_stale_ = true;
  } else if (late) {
    if (options_.turret) {
      struck_before_ = options_.joined_late == JoinedLate::kCut;
    } else {
      take_as_cut(driven_);
    }
    note_late_start(place);
    guard_stale_ = true;
  }
  driven_.clear();
  return point;
}

void LiveCutter::note_late_start(const FollowedPlace& place) {
  Finding finding =
      finding_of(FindingId::kLateStart, Severity::kNote, t_s_, place.here.tip_mm, place.tool);
  finding.source = {0, static_cast<std::uint32_t>(std::max(0, place.line))};
  if (options_.joined_late == JoinedLate::kCut) {
    finding.text =
        "the machine was here already when it was first seen; what the program cuts before is "
        "taken as cut";
    finding.hint = "--joined-late keep leaves the workpiece as it was given";
  } else {
    finding.text =
        "the machine was here already when it was first seen; what the program cuts before is not "
        "cut";
    finding.hint = "--joined-late cut takes it as cut";
  }
  log_.add(std::move(finding));
}

/// Number of the first motion of the machine's line that its tip is on.
std::optional<std::uint64_t> LiveCutter::motion_at(const FollowedPlace& place) const {
  if (!options_.reopen || place.line <= 0) return std::nullopt;
  const std::unique_ptr<Program> program = options_.reopen();
  if (!program) return std::nullopt;
  std::optional<std::uint64_t> found;
  std::uint64_t number = 0;
  Diagnostics ignored;
  program->run(
      [&](std::span<const Motion> motions) {
        for (const Motion& m : motions) {
          const bool here = m.source.file == 0 && m.start_known &&
                            m.source.line == static_cast<std::uint32_t>(place.line) &&
                            (m.kind == MotionKind::kTraverse || is_feed(m));
          const ProgramPlace at = here ? place_on(m, place) : ProgramPlace{};
          const TurnedAxes turned{at.abc_deg, place.abc_known, options_.follow.lever_mm, at.uvw_mm,
                                  place.uvw_known};
          const bool turns = m.from_abc_deg != m.to_abc_deg || m.from_uvw_mm != m.to_uvw_mm;
          if (here && nearest_on(m, at.tip_mm, turns ? turned : TurnedAxes{}, 0).distance_mm <=
                          options_.follow.tolerance_mm) {
            found = number;
            return false;
          }
          ++number;
        }
        return true;
      },
      {}, ignored);
  return found;
}

/// Up to this motion of the program, without a word.
void LiveCutter::pass(std::uint64_t motion) {
  cut_run();
  stage_.hold_reports();
  double begin_s = 0;
  while (ahead_->forgotten() + ahead_->motions().size() <= motion) {
    for (const PlannedMotion& planned : ahead_->motions()) begin_s = planned.end_s;
    pass_planned(ahead_->motions().size());
    follower_.begin_at(begin_s);
    const std::uint64_t before = ahead_->forgotten();
    ahead_->read_until(begin_s + kPlannedAhead_s, true);
    if (ahead_->motions().empty() && ahead_->forgotten() == before && ahead_->complete()) break;
  }
  const auto left = static_cast<std::size_t>(motion - ahead_->forgotten());
  if (left < ahead_->motions().size()) begin_s = ahead_->motions()[left].start_s;
  pass_planned(std::min(left, ahead_->motions().size()));
  follower_.begin_at(begin_s);
  stage_.release_reports();
}

/// The first `count` motions that have been planned, as the program has them.
void LiveCutter::pass_planned(std::size_t count) {
  if (options_.joined_late == JoinedLate::kCut && !options_.seen_before) {
    for (std::size_t i = 0; i < count; ++i) cut_now(ahead_->motions()[i].motion, 0, t_s_);
  }
  ahead_->forget(count);
  punched_ = ahead_->forgotten();
}

/// What lies on the path before the place where the machine was found, without a word.
void LiveCutter::take_as_cut(std::span<const PathFollower::DrivenPart> parts) {
  if (options_.joined_late != JoinedLate::kCut) return;
  stage_.hold_reports();
  for (const PathFollower::DrivenPart& part : parts) cut_now(part.motion, 0, t_s_);
  stage_.release_reports();
}

}  // namespace kerf
