#include "twin/live/path_follower.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "interp_bridge/motion_kinds.h"
#include "twin/machine/planned_pieces.h"
#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"

namespace kerf {
namespace {

/// Before the machine has been found, it may start anywhere within so much of the program. s.
constexpr double kFirstSearch_s = 5.0;

/// One that was out of sight for longer may have passed the first place that it fits. s.
constexpr double kHidden_s = 0.1;
/// And shows it by then, s, by leaving the path by more than this, mm.
constexpr double kHiddenFor_s = 10.0;
constexpr double kAside_mm = 0.1;

}  // namespace

std::array<double, 3> nearest_turns(const std::array<double, 3>& abc_deg,
                                    const std::array<double, 3>& to_deg) {
  // Every attitude has two such triples, and each of their angles as many as there are turns.
  const std::array<std::array<double, 3>, 2> both{
      abc_deg, {abc_deg[0] + 180, 180 - abc_deg[1], abc_deg[2] + 180}};
  std::array<double, 3> best = abc_deg;
  double least = std::numeric_limits<double>::infinity();
  for (std::array<double, 3> one : both) {
    double off = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      one[i] += 360 * std::round((to_deg[i] - one[i]) / 360);
      off += std::abs(one[i] - to_deg[i]);
    }
    if (off >= least) continue;
    least = off;
    best = one;
  }
  return best;
}

ProgramPose place_on(const Motion& m, const MatchQuery& place) {
  ProgramPose here = place.here;
  bool arm = false;
  if (place.machine) {
    const int type = place.machine->type_of(m);
    here = place.by_type[static_cast<std::size_t>(type)];
    arm = place.machine->type(type).mode == KinematicsMode::kArm;
  }
  if (place.without_length) here.tip_mm -= m.tool_offset_mm.z * here.along_tool;
  if (place.applied_length) here.tip_mm += m.length.tip_shift_mm;
  if (arm) here.abc_deg = nearest_turns(here.abc_deg, m.to_abc_deg);
  return here;
}

void PathFollower::begin_at(double program_s) {
  while (!pieces_.empty() && pieces_.front().start_s + pieces_.front().duration_s <= program_s) {
    pieces_.pop_front();
  }
  t_ = 0;
  unseen_s_ = 0;
  found_ = true;
}

void PathFollower::append(const Motion& motion, const TimedStep& timed,
                          std::span<const PathPiece> path) {
  end_s_ = timed.start_s + timed.duration_s;
  ++appended_;
  if (!is_move(motion)) return;
  if (!motion.start_known && pieces_.empty() && !found_) {
    approach_line_ = motion.source.file == 0 ? static_cast<int>(motion.source.line) : 0;
  }
  if (!motion.start_known) return;
  const bool turns =
      motion.from_abc_deg != motion.to_abc_deg || motion.from_uvw_mm != motion.to_uvw_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    slid_[i] = slid_[i] || motion.from_uvw_mm[axis] != motion.to_uvw_mm[axis];
    turned_[i] = turned_[i] || motion.from_abc_deg[i] != motion.to_abc_deg[i];
  }
  // Where something turns, or U, V, W move, the planned path is the motion itself.
  if (path.empty() || turns) {
    const bool is_arc = motion.kind == MotionKind::kArc && motion.arc.sweep_rad != 0;
    if (motion.from_mm == motion.to_mm && !turns && !is_arc) return;
    add(motion, timed);
    return;
  }
  for_each_piece(motion, timed, path,
                 [this](const Motion& piece, const TimedStep& part) { add(piece, part); });
}

void PathFollower::add(const Motion& motion, const TimedStep& timed) {
  pieces_.push_back({motion, timed.start_s, timed.duration_s, moved_s_, appended_ - 1, turned_,
                     slid_, timed.way});
  moved_s_ += timed.duration_s;
}

double PathFollower::program_s() const {
  if (pieces_.empty()) return end_s_;
  return found_ ? pieces_.front().time_at(t_) : pieces_.front().start_s;
}

bool PathFollower::passed_all() const {
  return pieces_.empty() || (pieces_.size() == 1 && found_ && t_ >= 1);
}

bool PathFollower::comes_to(int line) const {
  const double until_s = program_s() + kFirstSearch_s;
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& piece) {
    const SourceRef& source = piece.motion.source;
    return piece.start_s < until_s &&
           (source.file != 0 || source.line == static_cast<std::uint32_t>(line));
  });
}

double PathFollower::left_s() const {
  if (pieces_.empty()) return 0;
  return moved_s_ - pieces_.front().moved_s - (found_ ? pieces_.front().spent_s(t_) : 0);
}

PointOnWay PathFollower::nearest_of(const Piece& piece, const MatchQuery& place, double from_t,
                                    double to_t) const {
  const ProgramPose here = place_on(piece.motion, place);
  TurnedAxes turned{here.abc_deg, place.abc_known, options_.lever_mm, here.uvw_mm, place.uvw_known};
  for (std::size_t i = 0; i < 3; ++i) {
    turned.counts[i] = turned.counts[i] && piece.turned[i];
    turned.uvw_counts[i] = turned.uvw_counts[i] && piece.slid[i];
  }
  return nearest_on(piece.motion, here.tip_mm, turned, from_t, to_t);
}

/// As far as the machine can have come. That may be within a piece: a full circle ends where it
/// begins.
PathFollower::Reach PathFollower::reach(const MatchQuery& place, double hidden_s) const {
  // How long the machine stands in a dwell or a tool change is not the path's business.
  const Piece& first = pieces_.front();
  const double ahead_s =
      found_ ? first.spent_s(t_) + unseen_s_ * options_.haste + options_.slack_s : kFirstSearch_s;
  const double latest_s = first.moved_s + ahead_s + hidden_s;
  const int tool = pieces_.front().motion.tool;
  const bool tool_agrees = place.tool >= 0 && place.tool == tool;
  std::size_t end = 0;
  while (end < pieces_.size() && pieces_[end].moved_s <= latest_s) {
    if (tool_agrees && pieces_[end].motion.tool != tool) break;
    ++end;
  }
  return {std::max<std::size_t>(end, 1), latest_s};
}

/// The first place that is nearly as near as the nearest. `line` > 0: only on pieces of that line;
/// `tool` >= 0: only on pieces of that tool.
std::optional<PathFollower::Candidate> PathFollower::search(const MatchQuery& place,
                                                            const Reach& reach, int line,
                                                            int tool) const {
  std::optional<Candidate> nearest;
  std::optional<Candidate> first;  // within the ambiguity of the nearest so far
  for (std::size_t i = 0; i < reach.end; ++i) {
    const Motion& m = pieces_[i].motion;
    if (line > 0 && (m.source.file != 0 || m.source.line != static_cast<std::uint32_t>(line))) {
      continue;
    }
    if (tool >= 0 && m.tool != tool) continue;
    const double from_t = i == 0 ? t_ : 0;
    const double to_t = std::max(from_t, pieces_[i].share_at(reach.latest_s));
    const PointOnWay point = nearest_of(pieces_[i], place, from_t, to_t);
    const Candidate here{i, point.t, point.distance_mm};
    if (!nearest || here.distance_mm < nearest->distance_mm) nearest = here;
    // A better place at the far side of an ambiguity, or the same approach going on.
    const bool better = !first || here.distance_mm < first->distance_mm - options_.ambiguity_mm;
    const bool goes_on =
        first && first->piece + 1 == i && first->t >= 1 && here.distance_mm <= first->distance_mm;
    if (better || goes_on) first = here;
  }
  if (!nearest) return std::nullopt;
  return first;
}

/// What its line tells of a machine that has not been found yet. On its way to the program's first
/// place it says a line that may come again later, in a loop.
int PathFollower::told_line(const MatchQuery& place) const {
  return found_ || place.line != approach_line_ ? place.line : -1;
}

bool PathFollower::has_line(int line) const {
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& piece) {
    return piece.motion.source.file == 0 &&
           piece.motion.source.line == static_cast<std::uint32_t>(line);
  });
}

/// Exactly where the machine is, farther on than it can have come since it was last found.
std::optional<PathFollower::Candidate> PathFollower::search_hidden(const MatchQuery& place,
                                                                   int line, const Candidate& at) {
  seen_s_ += place.elapsed_s;
  if (seen_s_ > kHiddenFor_s) hidden_s_ = 0;
  if (hidden_s_ <= 0 || at.distance_mm <= kAside_mm) return std::nullopt;
  const std::optional<Candidate> later =
      search(place, reach(place, hidden_s_), std::max(line, 0), place.tool);
  const bool is_it = later && later->distance_mm <= options_.ambiguity_mm;
  return is_it ? later : std::nullopt;
}

/// The machine is at `at`, and can have come to `latest_s`.
void PathFollower::note_hidden(double latest_s, const Candidate& at) {
  if (unseen_s_ <= kHidden_s || !found_) return;
  const Piece& piece = pieces_[at.piece];
  hidden_s_ = std::max(0.0, latest_s - piece.moved_s - piece.spent_s(at.t));
  seen_s_ = 0;
}

/// At either end of the piece that is nearest.
RoundedCorner PathFollower::corner_at(const Candidate& at, const MatchQuery& place) const {
  RoundedCorner found = RoundedCorner::kNone;
  for (std::size_t i = at.piece == 0 ? 1 : at.piece; i <= at.piece + 1 && i < pieces_.size(); ++i) {
    const Motion& before = pieces_[i - 1].motion;
    const Vec3 tip_mm = place_on(before, place).tip_mm;
    const RoundedCorner corner =
        rounded_corner(before, pieces_[i].motion, tip_mm, at.distance_mm, options_.tolerance_mm);
    if (corner == RoundedCorner::kRight) return corner;
    if (found == RoundedCorner::kNone) found = corner;
  }
  return found;
}

void PathFollower::drive_to(const Candidate& to, const Drive& drive) {
  for (std::size_t i = 0; i < to.piece; ++i) {
    const Piece& piece = pieces_.front();
    if (t_ < 1) drive({part_of(piece.motion, t_, 1), piece.duration_s - piece.spent_s(t_), t_ > 0});
    pieces_.pop_front();
    t_ = 0;
  }
  const Piece& piece = pieces_.front();
  if (to.t > t_)
    drive({part_of(piece.motion, t_, to.t), piece.spent_s(to.t) - piece.spent_s(t_), t_ > 0});
  t_ = to.t;
}

PathMatch PathFollower::follow(const MatchQuery& place, const Drive& drive) {
  PathMatch point;
  point.distance_mm = std::numeric_limits<double>::infinity();
  // Line 0: the machine runs no program yet.
  if (pieces_.empty() || (!found_ && place.line == 0)) return point;
  unseen_s_ += place.elapsed_s;
  const Reach end = reach(place, 0);
  // What the machine says of itself goes first, but need not be so.
  std::optional<Candidate> at;
  const auto missed = [&] { return !at || at->distance_mm > options_.tolerance_mm; };
  const int line = told_line(place);
  if (line > 0) at = search(place, end, line, place.tool);
  // One that begins in the midst comes by other places of the path on its way.
  const bool by_line = !found_ && line > 0 && has_line(line);
  if (missed() && by_line) at = search(place, end, line, -1);  // with another tool in the spindle
  if (missed() && !by_line && place.tool >= 0) at = search(place, end, 0, place.tool);
  if (missed() && !by_line) at = search(place, end, 0, -1);
  if (at && found_) {
    if (const auto later = search_hidden(place, line, *at)) at = later;
  }
  // A machine that was out of sight may be anywhere, and says where.
  point.in_reach = !missed();
  if (missed() && line > 0) {
    const auto far = search(place, {pieces_.size()}, line, place.tool);
    if (far && far->distance_mm <= options_.tolerance_mm) at = far;
  }
  if (!at) return point;
  const Piece& piece = pieces_[at->piece];
  point.distance_mm = at->distance_mm;
  point.place.tip_mm = point_at(piece.motion, at->t);
  for (std::size_t i = 0; i < 3; ++i) {
    const double from = piece.motion.from_abc_deg[i];
    const double to = piece.motion.to_abc_deg[i];
    point.place.abc_deg[i] = at->t >= 1 ? to : from + at->t * (to - from);
  }
  point.place.along_tool = place_on(piece.motion, place).along_tool;
  point.place.uvw_mm =
      piece.motion.from_uvw_mm + at->t * (piece.motion.to_uvw_mm - piece.motion.from_uvw_mm);
  point.turned = piece.turned;
  point.slid = piece.slid;
  if (place.machine) point.kinematics_type = place.machine->type_of(piece.motion);
  point.source = piece.motion.source;
  point.tool = piece.motion.tool;
  const ToolLengthState& length = piece.motion.length;
  point.length = length;
  point.tip_shift_mm = length.tip_shift_mm;
  if (length.verdict == ToolLengthState::Verdict::kStated) {
    point.stated_length_mm = length.applied_mm.z;
  }
  point.tool_length_mm = piece.motion.tool_offset_mm.z;
  point.program_s = piece.time_at(at->t);
  point.motion = piece.number;
  point.share = at->t;
  if (at->distance_mm > options_.tolerance_mm) {
    point.corner = corner_at(*at, place);
    return point;
  }
  point.on_path = true;
  if (point.in_reach) note_hidden(end.latest_s, *at);
  found_ = true;
  drive_to(*at, drive);
  unseen_s_ = 0;
  return point;
}

}  // namespace kerf
