#include "twin/live/path_follower.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "twin/motion_geometry.h"
#include "twin/motion_nearest.h"

namespace kerf {
namespace {

/// Before the machine has been found, it may start anywhere within so much of the program. s.
constexpr double kFirstSearch_s = 5.0;

bool moves(const Motion& m) {
  return m.kind == MotionKind::kTraverse || m.kind == MotionKind::kProbe || is_feed(m);
}

}  // namespace

Vec3 tip_on(const Motion& m, const FollowedPlace& place) {
  Vec3 tip = place.tip_mm;
  if (place.without_length) tip.z -= m.tool_offset_mm.z;
  return tip;
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
  if (!moves(motion) || !motion.start_known) return;
  if (path.empty()) {
    if (motion.from_mm == motion.to_mm) return;
    add(motion, timed.start_s, timed.duration_s);
    return;
  }
  Motion piece = motion;
  const double share_s = timed.duration_s / static_cast<double>(path.size());
  double start_s = timed.start_s;
  for (const PathPiece& part : path) {
    piece.kind = part.curved                       ? MotionKind::kArc
                 : motion.kind == MotionKind::kArc ? MotionKind::kFeed
                                                   : motion.kind;
    piece.from_mm = part.from_mm;
    piece.to_mm = part.to_mm;
    piece.arc = part.arc;
    add(piece, start_s, share_s);
    start_s += share_s;
  }
}

void PathFollower::add(const Motion& motion, double start_s, double duration_s) {
  pieces_.push_back({motion, start_s, duration_s, moved_s_});
  moved_s_ += duration_s;
}

double PathFollower::program_s() const {
  if (pieces_.empty()) return end_s_;
  return found_ ? pieces_.front().time_at(t_) : pieces_.front().start_s;
}

bool PathFollower::passed_all() const {
  return pieces_.empty() || (pieces_.size() == 1 && found_ && t_ >= 1);
}

/// One past the last piece that the machine can have reached.
std::size_t PathFollower::reach(const FollowedPlace& place) const {
  // How long the machine stands in a dwell or a tool change is not the path's business.
  const Piece& first = pieces_.front();
  const double ahead_s = found_
                             ? t_ * first.duration_s + unseen_s_ * options_.haste + options_.slack_s
                             : kFirstSearch_s;
  const double latest_s = first.moved_s + ahead_s;
  const int tool = pieces_.front().motion.tool;
  const bool tool_agrees = place.tool >= 0 && place.tool == tool;
  std::size_t end = 0;
  while (end < pieces_.size() && pieces_[end].moved_s <= latest_s) {
    if (tool_agrees && pieces_[end].motion.tool != tool) break;
    ++end;
  }
  return std::max<std::size_t>(end, 1);
}

/// The first place that is nearly as near as the nearest. `line` > 0: only on pieces of that line;
/// `tool` >= 0: only on pieces of that tool.
std::optional<PathFollower::Candidate> PathFollower::search(const FollowedPlace& place,
                                                            std::size_t end, int line,
                                                            int tool) const {
  std::optional<Candidate> nearest;
  std::optional<Candidate> first;  // within the ambiguity of the nearest so far
  for (std::size_t i = 0; i < end; ++i) {
    const Motion& m = pieces_[i].motion;
    if (line > 0 && (m.source.file != 0 || m.source.line != static_cast<std::uint32_t>(line))) {
      continue;
    }
    if (tool >= 0 && m.tool != tool) continue;
    const NearestPoint point = nearest_on(m, tip_on(m, place), i == 0 ? t_ : 0);
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

void PathFollower::drive_to(const Candidate& to, const Drive& drive) {
  for (std::size_t i = 0; i < to.piece; ++i) {
    const Piece& piece = pieces_.front();
    if (t_ < 1) drive(part_of(piece.motion, t_, 1), (1 - t_) * piece.duration_s);
    pieces_.pop_front();
    t_ = 0;
  }
  const Piece& piece = pieces_.front();
  if (to.t > t_) drive(part_of(piece.motion, t_, to.t), (to.t - t_) * piece.duration_s);
  t_ = to.t;
}

FollowedPoint PathFollower::follow(const FollowedPlace& place, const Drive& drive) {
  FollowedPoint point;
  point.distance_mm = std::numeric_limits<double>::infinity();
  // Line 0: the machine runs no program yet.
  if (pieces_.empty() || (!found_ && place.line == 0)) return point;
  unseen_s_ += place.elapsed_s;
  const std::size_t end = reach(place);
  // What the machine says of itself goes first, but need not be so.
  std::optional<Candidate> at;
  const auto missed = [&] { return !at || at->distance_mm > options_.tolerance_mm; };
  if (place.line > 0) at = search(place, end, place.line, place.tool);
  if (missed() && place.tool >= 0) at = search(place, end, 0, place.tool);
  if (missed()) at = search(place, end, 0, -1);
  // A machine that was out of sight may be anywhere, and says where.
  if (missed() && place.line > 0 && end < pieces_.size()) {
    const auto far = search(place, pieces_.size(), place.line, place.tool);
    if (far && far->distance_mm <= options_.tolerance_mm) at = far;
  }
  if (!at) return point;
  const Piece& piece = pieces_[at->piece];
  point.distance_mm = at->distance_mm;
  point.place_mm = point_at(piece.motion, at->t);
  point.source = piece.motion.source;
  point.tool = piece.motion.tool;
  point.tool_length_mm = piece.motion.tool_offset_mm.z;
  point.program_s = piece.time_at(at->t);
  if (at->distance_mm > options_.tolerance_mm) return point;
  point.on_path = true;
  if (!found_) {
    // The way to where the machine was first seen has not been seen.
    found_ = true;
    for (std::size_t i = 0; i < at->piece; ++i) pieces_.pop_front();
    t_ = at->t;
  } else {
    drive_to(*at, drive);
  }
  unseen_s_ = 0;
  return point;
}

}  // namespace kerf
