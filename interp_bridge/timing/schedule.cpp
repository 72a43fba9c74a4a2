#include "interp_bridge/timing/schedule.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/portable_math.h"

namespace kerf {
namespace {

/// Farthest that the chords of a corner may lie from the way of the tool.
constexpr double kCornerChord_mm = 0.001;

/// A way that is as even as this is given as even: most of dense code is.
constexpr double kEven_s = 0.0005;

/// Room for what the look-ahead usually holds; grows where many short moves are merged.
constexpr std::size_t kFirstCapacity = 1024;

/// std::clamp() of values: that of references goes through memory.
double within(double value, double least, double most) {
  return std::min(std::max(value, least), most);
}

/// `r` turned about the unit vector `axis`, to which it is normal.
Vec3 turned(const Vec3& r, const Vec3& axis, double angle) {
  return portable::cos(angle) * r + portable::sin(angle) * glm::cross(axis, r);
}

}  // namespace

Schedule::Schedule(MotionPlanSink& sink, bool with_path)
    : sink_(sink), with_path_(with_path), pending_(kFirstCapacity), pieces_(kFirstCapacity) {}

void Schedule::open_motion(double programmed_mm_per_min, double allowed_mm_per_min,
                           std::uint32_t pieces) {
  Pending& pending = pending_.push();
  MotionTiming& timing = pending.timing;
  timing.index = next_index_++;
  timing.start_s = timing.duration_s = timing.peak_mm_per_min = 0;
  timing.programmed_mm_per_min = programmed_mm_per_min;
  timing.allowed_mm_per_min = allowed_mm_per_min;
  timing.way = {};
  pending.pieces_left = pieces;
  pending.started = false;
  pending.middles = 0;
  pending.in_s = pending.out_s = 0;
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

Schedule::Pending& Schedule::add_time(std::uint64_t motion, double seconds, double speed) {
  Pending& pending = pending_[motion];
  if (!pending.started) {
    pending.started = true;
    pending.timing.start_s = clock_s_ + corner_s_;
  }
  pending.timing.duration_s += seconds - std::exchange(corner_s_, 0);
  pending.timing.peak_mm_per_min = std::max(pending.timing.peak_mm_per_min, speed * 60.0);
  clock_s_ += seconds;
  return pending;
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
    MotionTiming& timing = pending.timing;
    if (!pending.started) timing.start_s = clock_s_;
    timing.duration_s = std::max(timing.duration_s, 0.0);
    if (pending.middles == 1 && timing.duration_s > 0) {
      const double in = pending.in_s / timing.duration_s;
      timing.way.in_time = static_cast<float>(std::clamp(in, 0.0, 1.0));
      const double out = pending.out_s / timing.duration_s;
      timing.way.out_time = static_cast<float>(std::clamp(out, 0.0, 1.0 - std::min(in, 1.0)));
      if (timing.duration_s * timing.way.unevenness() < kEven_s) timing.way = {};
    } else {
      timing.way = {};
    }
    pending_.pop_front();
    sink_.timed(timing);  // nothing is pushed meanwhile
  }
}

void Schedule::settle() {
  if (held_) close_piece();
}

void Schedule::run(const Segment& segment, const SpeedProfile& profile, const Overlap& overlap) {
  const double seconds = std::max(profile.duration_s - overlap.seconds, 0.0);
  if (segment.shape == SegmentShape::kBlend) {
    corner_before_mm_ = segment.length_mm;
    run_blend(segment, seconds, profile);
    return;
  }
  settle();
  if (!corner_mm_.empty()) send_chords(corner_mm_.size() / 2, corner_mm_.size() - 1);
  corner_mm_.clear();
  if (with_path_) round_corner(segment, overlap);
  run_pieces(segment, seconds, profile, overlap.seconds / 2);
  if (!corner_mm_.empty()) send_chords(0, corner_mm_.size() / 2);
  corner_behind_mm_ = corner_ahead_mm_;
  corner_ahead_mm_ = 0;
}

/// Both segments at once: what is left of the first, braking, and what has been run of the second.
void Schedule::round_corner(const Segment& segment, const Overlap& overlap) {
  corner_before_mm_ = segment.length_mm;
  if (overlap.seconds <= 0 || segment.extra || overlap.next->extra) return;
  const Segment& next = *overlap.next;
  const double whole_s = overlap.seconds;
  const double open_mm = segment.length_mm - corner_behind_mm_;
  const double most_s = std::sqrt(2 * std::max(open_mm, 0.0) / overlap.braking);
  const double time_s = std::min(whole_s, most_s);
  const auto left_mm = [&](double t) { return overlap.braking * (time_s - t) * (time_s - t) / 2; };
  const auto run_mm = [&](double t) {
    const double gaining_s = std::min(t, overlap.speed / overlap.speeding);
    const double gained = overlap.speeding * gaining_s * gaining_s / 2;
    return std::min(gained + overlap.speed * (t - gaining_s), next.length_mm);
  };
  const double turn = overlap.braking + overlap.speeding;
  const double steps = std::ceil(time_s / std::sqrt(8 * kCornerChord_mm / turn));
  const int count = 2 * static_cast<int>(std::clamp(steps / 2, 1.0, 64.0));
  const Vec3 corner = segment.point_at(segment.length_mm);
  for (int i = 0; i <= count; ++i) {
    const double t = time_s * i / count;
    corner_mm_.push_back(segment.point_at(segment.length_mm - left_mm(t)) +
                         (next.point_at(run_mm(t)) - corner));
  }
  corner_before_mm_ = segment.length_mm - left_mm(0);
  corner_ahead_mm_ = run_mm(time_s);
}

void Schedule::send_chords(std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    sink_.path({false, corner_mm_[i], corner_mm_[i + 1], {}});
  }
}

namespace {

/// How the way of a segment goes, with what its corners have left of it.
WayInTime middle_of(const Segment& segment, const SpeedProfile& profile) {
  WayInTime middle;
  if (segment.slow_from > 0) {
    middle.set_slowness(segment.slow_from, segment.slow_to, 1 / segment.spindle_speed);
  } else {
    middle.set_ramps(segment.length_mm, segment.accel(), profile.start_speed, profile.cruise_speed,
                     profile.end_speed);
  }
  return middle;
}

/// From where to where, in shares of its way, a segment is run by itself. What is run together with
/// its neighbours takes half of that time for it: evenly, at the speed that it is entered with.
///
///     |--- a t^2 / 2 ---|  in t / 2: at a t, as it was when it began to brake
struct AloneRange {
  double from = 0, to = 1;
  AloneRange(const WayInTime& middle, double moving_s, double before_s, double behind_s) {
    if (before_s > 0 && moving_s > 0) from = middle.way_of(before_s / moving_s);
    if (behind_s > 0 && moving_s > 0) to = middle.way_of(1 - behind_s / moving_s);
    to = std::max(to, from);
  }
};

}  // namespace

/// Shares the time among the pieces by their way; the last one stays open for the blend after it.
/// `corner_s`: half of the time in which the next segment is run too.
void Schedule::run_pieces(const Segment& segment, double seconds, const SpeedProfile& profile,
                          double corner_s) {
  const bool blend = segment.shape == SegmentShape::kBlend;
  const WayInTime middle = blend ? WayInTime{} : middle_of(segment, profile);
  const AloneRange alone(middle, profile.duration_s - profile.rest_s, 2 * corner_s_, 2 * corner_s);
  const double begins_s = corner_s_;
  const double moving_s = std::max(seconds - profile.rest_s, 0.0);
  const double cut_from = blend ? 0 : segment.cut_from();
  const double left = std::max(1 - cut_from - (blend ? 0 : segment.cut_to()), 1e-9);
  double whole = 0;
  for (std::uint32_t i = 0; i < segment.piece_count; ++i) {
    whole += pieces_[segment.first_piece + i].length_mm;
  }
  double done = 0;
  double run = 0;
  for (std::uint32_t i = 0; i < segment.piece_count; ++i) {
    if (i > 0) close_piece();
    const bool last = i + 1 == segment.piece_count;
    const Piece piece = pieces_.front();
    const double share = whole > 0 ? piece.length_mm / whole : 1.0;
    const double ends = last ? 1.0 : done + share;
    // Between its ends the piece is on so much of the segment's own way.
    const double from = within((done - cut_from) / left, alone.from, alone.to);
    const double to = last ? alone.to : within((ends - cut_from) / left, from, alone.to);
    const double run_to = last ? 1.0 : middle.time_of(to);
    const double piece_s = moving_s * (run_to - run) + (last ? seconds - moving_s : 0);
    Pending& pending = add_time(piece.motion, piece_s, profile.peak_speed);
    run = run_to;
    if (i == 0) pending.in_s += begins_s;
    pending.middles += blend ? 2 : 1;
    WayInTime& way = pending.timing.way;
    way = from > 0 || to < 1 ? middle.part(from, to) : middle;
    if (ends > done) {
      const double in = (cut_from + left * from - done) / (ends - done);
      const double out = (ends - cut_from - left * to) / (ends - done);
      way.in_way = static_cast<float>(within(in, 0.0, 1.0));
      way.out_way = static_cast<float>(within(out, 0.0, 1.0));
    }
    if (last) {
      pending.out_s += profile.rest_s + corner_s;
      pending.timing.duration_s += corner_s;
    }
    if (with_path_ && segment.shape == SegmentShape::kArc) {
      send_arc(segment, corner_behind_mm_, corner_before_mm_);
    } else if (with_path_) {
      const double length = blend ? segment.lead_mm : segment.length_mm;
      const double end = last ? length : (done + share) * length;
      send_line(segment, std::max(done * length, corner_behind_mm_),
                std::min(end, corner_before_mm_));
    }
    done += share;
  }
  held_ = segment.piece_count > 0;
  corner_s_ = corner_s;
}

void Schedule::run_blend(const Segment& segment, double seconds, const SpeedProfile& profile) {
  const double arc_mm = segment.length_mm - segment.lead_mm;
  const double after = seconds * 0.5 * arc_mm / segment.length_mm;
  if (segment.piece_count > 0) {
    settle();
    run_pieces(segment, seconds - after, profile, 0);
  } else if (held_) {
    Pending& pending = add_time(pieces_.front().motion, seconds - after, profile.peak_speed);
    pending.out_s += seconds - after;
  }
  if (with_path_) send_blend_half(segment, true);
  settle();
  if (pieces_.empty()) return;
  Pending& pending = add_time(pieces_.front().motion, after, profile.peak_speed);
  pending.in_s += after;
  if (with_path_) send_blend_half(segment, false);
}

void Schedule::send_line(const Segment& segment, double from_mm, double to_mm) {
  const bool blend = segment.shape == SegmentShape::kBlend;
  const Vec3& u = segment.tangent_from;
  const double length = blend ? segment.lead_mm : segment.length_mm;
  if (!segment.linear || length <= 0 || to_mm <= from_mm) return;
  const Vec3 start = segment.from + segment.trim_from * u;
  const Vec3 end = segment.trim_to > 0 || blend ? start + length * u : segment.to;
  const Vec3 from = from_mm > 0 ? start + from_mm * u : start;
  const Vec3 to = to_mm < length ? start + to_mm * u : end;
  sink_.path({false, from, to, {}});
}

void Schedule::send_arc(const Segment& segment, double from_mm, double to_mm) {
  if (to_mm <= from_mm) return;
  PathPiece piece;
  piece.curved = true;
  const bool whole_start = segment.trim_from <= 0 && from_mm <= 0;
  const bool whole_end = segment.trim_to <= 0 && to_mm >= segment.length_mm;
  piece.from_mm = whole_start ? segment.from : segment.point_at(from_mm);
  piece.to_mm = whole_end ? segment.to : segment.point_at(to_mm);
  piece.arc = segment.arc;
  const double left = std::abs(segment.arc.sweep_rad) - segment.trim_from - segment.trim_to;
  const double share = (to_mm - from_mm) / segment.length_mm;
  piece.arc.sweep_rad = segment.arc.sweep_rad < 0 ? -left * share : left * share;
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
