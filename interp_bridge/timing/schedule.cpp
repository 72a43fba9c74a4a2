#include "interp_bridge/timing/schedule.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// Room for what the look-ahead usually holds; grows where many short moves are merged.
constexpr std::size_t kFirstCapacity = 1024;

/// `r` turned about the unit vector `axis`, to which it is normal.
Vec3 turned(const Vec3& r, const Vec3& axis, double angle) {
  return std::cos(angle) * r + std::sin(angle) * glm::cross(axis, r);
}

}  // namespace

Schedule::Schedule(MotionPlanSink& sink, bool with_path)
    : sink_(sink), with_path_(with_path), pending_(kFirstCapacity), pieces_(kFirstCapacity) {}

void Schedule::open_motion(const MotionTiming& timing, std::uint32_t pieces) {
  Pending& pending = pending_.push();
  pending.timing = timing;
  pending.timing.index = next_index_++;
  pending.pieces_left = pieces;
  pending.started = false;
  if (pieces == 0) report_ready();
}

std::uint64_t Schedule::add_piece(double length_mm) {
  pieces_.push() = {pending_.end() - 1, length_mm};
  return pieces_.end() - 1;
}

void Schedule::alone(const Motion& motion, MotionTiming timing, double seconds, double speed) {
  settle();
  timing.index = next_index_++;
  timing.start_s = clock_s_;
  timing.duration_s = seconds;
  timing.peak_mm_per_min = speed * 60.0;
  clock_s_ += seconds;
  // Numbers of pending motions count all that were opened, reported at once or not.
  pending_.push();
  pending_.pop_front();
  if (with_path_ && speed > 0) sink_.path({false, motion.from_mm, motion.to_mm, {}});
  sink_.timed(timing);
}

void Schedule::drop_pieces(std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) close_piece();
}

void Schedule::add_time(std::uint64_t motion, double seconds, double speed) {
  Pending& pending = pending_[motion];
  if (!pending.started) {
    pending.started = true;
    pending.timing.start_s = clock_s_;
  }
  pending.timing.duration_s += seconds;
  pending.timing.peak_mm_per_min = std::max(pending.timing.peak_mm_per_min, speed * 60.0);
  clock_s_ += seconds;
}

void Schedule::close_piece() {
  Pending& pending = pending_[pieces_.front().motion];
  pieces_.pop_front();
  held_ = false;
  if (--pending.pieces_left == 0) report_ready();
}

void Schedule::report_ready() {
  while (!pending_.empty() && pending_.front().pieces_left == 0) {
    Pending& pending = pending_.front();
    if (!pending.started) pending.timing.start_s = clock_s_;
    const MotionTiming timing = pending.timing;
    pending_.pop_front();
    sink_.timed(timing);
  }
}

void Schedule::settle() {
  if (held_) close_piece();
}

void Schedule::run(const Segment& segment, const SpeedProfile& profile, double overlap_s) {
  const double seconds = std::max(profile.duration_s - overlap_s, 0.0);
  if (segment.shape == SegmentShape::kBlend) {
    run_blend(segment, seconds, profile.peak_speed);
    return;
  }
  settle();
  run_pieces(segment, seconds, profile.peak_speed);
}

/// Shares the time among the pieces by length; the last one stays open for the blend after it.
void Schedule::run_pieces(const Segment& segment, double seconds, double speed) {
  double whole = 0;
  for (std::uint32_t i = 0; i < segment.piece_count; ++i) {
    whole += pieces_[segment.first_piece + i].length_mm;
  }
  double done = 0;
  for (std::uint32_t i = 0; i < segment.piece_count; ++i) {
    if (i > 0) close_piece();
    const Piece piece = pieces_.front();
    const double share = whole > 0 ? piece.length_mm / whole : 1.0;
    add_time(piece.motion, seconds * share, speed);
    if (with_path_ && segment.shape == SegmentShape::kArc) {
      send_arc(segment);
    } else if (with_path_) {
      send_line(segment, done, i + 1 == segment.piece_count ? 1.0 : done + share);
    }
    done += share;
  }
  held_ = segment.piece_count > 0;
}

void Schedule::run_blend(const Segment& segment, double seconds, double speed) {
  const double arc_mm = segment.length_mm - segment.lead_mm;
  const double after = seconds * 0.5 * arc_mm / segment.length_mm;
  if (segment.piece_count > 0) {
    settle();
    run_pieces(segment, seconds - after, speed);
  } else if (held_) {
    add_time(pieces_.front().motion, seconds - after, speed);
  }
  if (with_path_) send_blend_half(segment, true);
  settle();
  if (pieces_.empty()) return;
  add_time(pieces_.front().motion, after, speed);
  if (with_path_) send_blend_half(segment, false);
}

void Schedule::send_line(const Segment& segment, double from_part, double to_part) {
  const bool blend = segment.shape == SegmentShape::kBlend;
  const Vec3& u = segment.tangent_from;
  const double length = blend ? segment.lead_mm : segment.length_mm;
  if (!segment.linear || length <= 0) return;
  const Vec3 start = segment.from + segment.trim_from * u;
  const Vec3 end = segment.trim_to > 0 || blend ? start + length * u : segment.to;
  const Vec3 from = from_part > 0 ? start + (from_part * length) * u : start;
  const Vec3 to = to_part < 1 ? start + (to_part * length) * u : end;
  sink_.path({false, from, to, {}});
}

void Schedule::send_arc(const Segment& segment) {
  PathPiece piece;
  const double whole = std::abs(segment.arc.sweep_rad);
  piece.curved = true;
  piece.from_mm = segment.trim_from > 0 ? segment.arc_point(segment.trim_from) : segment.from;
  piece.to_mm = segment.trim_to > 0 ? segment.arc_point(whole - segment.trim_to) : segment.to;
  piece.arc = segment.arc;
  const double left = whole - segment.trim_from - segment.trim_to;
  piece.arc.sweep_rad = segment.arc.sweep_rad < 0 ? -left : left;
  sink_.path(piece);
}

void Schedule::send_blend_half(const Segment& segment, bool first) {
  const Vec3 start = segment.from + segment.lead_mm * segment.tangent_from;
  const Vec3 middle = segment.arc.center_mm + turned(start - segment.arc.center_mm,
                                                     segment.arc.axis, segment.arc.sweep_rad / 2);
  PathPiece piece;
  piece.curved = true;
  piece.from_mm = first ? start : middle;
  piece.to_mm = first ? middle : segment.to;
  piece.arc = segment.arc;
  piece.arc.sweep_rad /= 2;
  sink_.path(piece);
}

}  // namespace kerf
