#include "twin/live/late_join.h"

#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"

namespace kerf {
namespace {

/// A machine that says it runs, and is not seen at the program's beginning, is looked for in all of
/// it after so long.
constexpr double kJoin_s = 0.3;
/// After a search of the whole program that found nothing, the next one comes after so many times
/// as long.
constexpr double kJoinAgain = 4;

}  // namespace

LateJoin::LateJoin(const LiveCutOptions& options, PathMatcher& matcher, WayCutter& cutter,
                   std::optional<PunchFollower>& punch)
    : options_(options),
      matcher_(matcher),
      cutter_(cutter),
      punch_(punch),
      join_after_s_(kJoin_s) {}

/// Nothing of what lies before has been seen: it is in the workpiece already, unless the machine
/// has been watched for long enough to have come there from the program's beginning.
LateJoin::Found LateJoin::find(const MatchQuery& query, double lost_sight_s, double t_s) {
  const double begin_s = matcher_.follower().program_s();
  watched_s_ += query.elapsed_s;
  Found found{matcher_.follow(query), false};
  if (found.point.on_path) {
    const double watched_s = options_.follow.haste * watched_s_ + options_.follow.slack_s;
    found.late = found.point.program_s - begin_s > watched_s;
  } else if (lost_sight_s >= join_after_s_) {
    join_after_s_ *= kJoinAgain;
    const std::optional<std::uint64_t> motion = motion_at(query);
    if (!motion) return found;
    pass(*motion, t_s);
    found = {matcher_.follow(query), true};
  }
  if (found.late && !options_.seen_before) take_before(t_s);
  matcher_.begin();
  return found;
}

/// What lies on the path before the place where the machine was found.
void LateJoin::take_before(double t_s) {
  if (options_.joined_late != JoinedLate::kCut) return;
  if (punch_) return punch_->strike_before();
  cutter_.stage().hold_reports();
  for (const PathFollower::DrivenPart& part : matcher_.driven()) {
    cutter_.cut_now(part.motion, 0, t_s);
  }
  cutter_.stage().release_reports();
}

/// Number of the first motion of the machine's line that its tip is on.
std::optional<std::uint64_t> LateJoin::motion_at(const MatchQuery& place) const {
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
          const ProgramPose at = here ? place_on(m, place) : ProgramPose{};
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
void LateJoin::pass(std::uint64_t motion, double t_s) {
  ProgramAhead& ahead = *matcher_.program();
  cutter_.cut_run();
  cutter_.stage().hold_reports();
  double begin_s = 0;
  while (ahead.forgotten() + ahead.motions().size() <= motion) {
    for (const PlannedMotion& planned : ahead.motions()) begin_s = planned.end_s;
    pass_planned(ahead.motions().size(), t_s);
    matcher_.begin_at(begin_s);
    const std::uint64_t before = ahead.forgotten();
    ahead.read_until(begin_s + kPlannedAhead_s, true);
    if (ahead.motions().empty() && ahead.forgotten() == before && ahead.complete()) break;
  }
  const auto left = static_cast<std::size_t>(motion - ahead.forgotten());
  if (left < ahead.motions().size()) begin_s = ahead.motions()[left].start_s;
  pass_planned(std::min(left, ahead.motions().size()), t_s);
  matcher_.begin_at(begin_s);
  cutter_.stage().release_reports();
}

/// The first `count` motions that have been planned, as the program has them.
void LateJoin::pass_planned(std::size_t count, double t_s) {
  ProgramAhead& ahead = *matcher_.program();
  if (options_.joined_late == JoinedLate::kCut && !options_.seen_before) {
    for (std::size_t i = 0; i < count; ++i) cutter_.cut_now(ahead.motions()[i].motion, 0, t_s);
  }
  ahead.forget(count);
  if (punch_) punch_->skip_to(ahead.forgotten());
}

}  // namespace kerf
