#include "stock/zmap/path_builder.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

/// XY length below which a segment counts as vertical, mm.
constexpr double kVertical_mm = 1e-9;
/// Up to this slope single precision keeps the height accuracy.
constexpr double kSlopeForFloat = 4.0;
/// Arcs that reach farther from their centre are cut in double precision.
constexpr double kArcReachForFloat_mm = 100.0;
/// Segments that turn by less (sine) are joined by a wedge; sharper corners get the whole tool.
constexpr double kJoinTurn = 0.3;
/// Sine of a turn that leaves no wedge worth cutting: the gap is below 1e-11 of the tool's radius,
/// the strips overlap by more.
constexpr double kStraightOn = 1e-11;
constexpr double kFullTurn_rad = 2 * kPi - 1e-9;

void set_box(SweepOp& op, const Vec3& a, const Vec3& b) {
  op.min_x = std::min(a.x, b.x);
  op.max_x = std::max(a.x, b.x);
  op.min_y = std::min(a.y, b.y);
  op.max_y = std::max(a.y, b.y);
}

SweepOp cap_op(const Vec3& tip, std::uint32_t report) {
  SweepOp op;
  op.kind = SweepOp::Kind::kCap;
  op.report = report;
  op.x = tip.x;
  op.y = tip.y;
  op.z = tip.z;
  set_box(op, tip, tip);
  return op;
}

/// A circle in XY that runs counter-clockwise from `start` to `end`.
struct FlatCircle {
  Vec2 center{0};
  double radius = 0;
  Vec2 start{0}, end{0};
  double sweep_rad = 0;
  bool reversed = false;
};

/// The circle of a level or helical arc, if it is one within kArcRadiusSlack_mm.
std::optional<FlatCircle> flat_circle(const CutMove& move) {
  const CutArc& arc = *move.arc;
  if (std::abs(arc.axis.x) > 1e-9 || std::abs(arc.axis.y) > 1e-9) return std::nullopt;
  FlatCircle c;
  const double turn = arc.sweep_rad * (arc.axis.z > 0 ? 1 : -1);
  c.reversed = turn < 0;
  c.sweep_rad = std::abs(turn);
  const Vec2 from(move.from_mm), to(move.to_mm);
  c.start = c.reversed ? to : from;
  c.end = c.reversed ? from : to;
  c.center = Vec2(arc.center_mm);
  const double r0 = glm::length(c.start - c.center), r1 = glm::length(c.end - c.center);
  if (std::abs(r0 - r1) > kArcRadiusSlack_mm || std::max(r0, r1) < 1e-6 || c.sweep_rad < 1e-12)
    return std::nullopt;
  const Vec2 chord = c.end - c.start;
  const double span = glm::length(chord);
  if (span > 1e-3) {
    const Vec2 along = chord / span;
    const double shift = glm::dot(0.5 * (c.start + c.end) - c.center, along);
    if (std::abs(shift) <= kArcRadiusSlack_mm) c.center += shift * along;
  }
  c.radius = 0.5 * (glm::length(c.start - c.center) + glm::length(c.end - c.center));
  return c;
}

/// Bounding box of a counter-clockwise arc.
void set_arc_box(SweepOp& op, const FlatCircle& c) {
  set_box(op, Vec3(c.start, 0), Vec3(c.end, 0));
  const Vec2 a = c.start - c.center, b = c.end - c.center;
  for (const Vec2 axis : {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)}) {
    const bool after = a.x * axis.y - a.y * axis.x >= 0, before = axis.x * b.y - axis.y * b.x >= 0;
    if (!(c.sweep_rad > kPi ? (after || before) : (after && before)) && c.sweep_rad < kFullTurn_rad)
      continue;
    const Vec2 p = c.center + c.radius * axis;
    op.min_x = std::min(op.min_x, p.x);
    op.max_x = std::max(op.max_x, p.x);
    op.min_y = std::min(op.min_y, p.y);
    op.max_y = std::max(op.max_y, p.y);
  }
}

/// Sine and cosine of a small angle from basic operations: libm's last bit differs between hosts,
/// the result must not.
void small_sin_cos(double a, double& s, double& c) {
  const double a2 = a * a;
  s = a * (1 - a2 / 6 * (1 - a2 / 20 * (1 - a2 / 42 * (1 - a2 / 72 * (1 - a2 / 110)))));
  c = 1 - a2 / 2 * (1 - a2 / 12 * (1 - a2 / 30 * (1 - a2 / 56 * (1 - a2 / 90 * (1 - a2 / 132)))));
}

}  // namespace

bool is_circle_in_xy(const CutMove& move) { return move.arc && flat_circle(move).has_value(); }

std::vector<Vec3> arc_chord_points(const CutMove& move, double tolerance_mm) {
  const CutArc& arc = *move.arc;
  const auto from_axis = [&](const Vec3& point) {
    const Vec3 from = point - arc.center_mm;
    return glm::length(from - glm::dot(from, arc.axis) * arc.axis);
  };
  const double r = std::max({from_axis(move.from_mm), from_axis(move.to_mm), 1e-9});
  const double sweep = std::abs(arc.sweep_rad);
  const double widest = 2 * std::sqrt(2 * tolerance_mm / r);  // sagitta of a chord: r * step^2 / 8
  const int n = std::max(1, static_cast<int>(std::ceil(sweep / std::min(widest, 0.5))));
  return arc_points(move, n);
}

std::vector<Vec3> arc_points(const CutMove& move, int n) {
  const CutArc& arc = *move.arc;
  const Vec3 axis = arc.axis;
  const Vec3 from = move.from_mm - arc.center_mm, to = move.to_mm - arc.center_mm;
  const double rise0 = glm::dot(from, axis), rise1 = glm::dot(to, axis);
  const Vec3 a = from - rise0 * axis;
  const double r0 = glm::length(a), r1 = glm::length(to - rise1 * axis);
  double sin_step, cos_step;
  small_sin_cos(arc.sweep_rad / n, sin_step, cos_step);
  const Vec3 u = r0 > 0 ? a / r0 : Vec3(1, 0, 0);
  const Vec3 v = glm::cross(axis, u);
  std::vector<Vec3> points;
  points.reserve(static_cast<std::size_t>(n));
  double c = 1, s = 0;
  for (int i = 1; i < n; ++i) {
    const double next_c = c * cos_step - s * sin_step;
    s = s * cos_step + c * sin_step;
    c = next_c;
    const double f = static_cast<double>(i) / n;
    points.push_back(arc.center_mm + (r0 + (r1 - r0) * f) * (c * u + s * v) +
                     (rise0 + (rise1 - rise0) * f) * axis);
  }
  points.push_back(move.to_mm);
  return points;
}

void PathBuilder::stand_at(const Vec3& tip, std::uint32_t report, std::vector<SweepOp>& ops) {
  if (standing_ && *standing_ == tip) return;
  ops.push_back(cap_op(tip, report));
  standing_ = tip;
}

SweepOp& PathBuilder::push_strip(std::vector<SweepOp>& ops) {
  const Segment& s = *pending_;
  SweepOp& op = ops.emplace_back();
  op.kind = SweepOp::Kind::kStrip;
  op.report = s.report;
  op.x = s.from.x;
  op.y = s.from.y;
  op.z = s.from.z;
  op.cos = s.cos;
  op.sin = s.sin;
  op.slope = s.slope;
  op.slope_m = s.slope_m;
  op.length = s.length;
  op.use_double = std::abs(s.slope) > kSlopeForFloat;
  set_box(op, s.from, s.to);
  return op;
}

void PathBuilder::finish(std::vector<SweepOp>& ops) {
  if (!pending_) return;
  push_strip(ops);
  stand_at(pending_->to, pending_->report, ops);
  pending_.reset();
}

bool PathBuilder::is_vertical(const CutMove& move) {
  const double dx = move.to_mm.x - move.from_mm.x, dy = move.to_mm.y - move.from_mm.y;
  return !move.arc && std::sqrt(dx * dx + dy * dy) < kVertical_mm;
}

void PathBuilder::add_segment(const Vec3& from, const Vec3& to, std::uint32_t report,
                              std::vector<SweepOp>& ops) {
  const double dx = to.x - from.x, dy = to.y - from.y;
  Segment s{from, to, report};
  s.length = std::sqrt(dx * dx + dy * dy);
  if (s.length < kVertical_mm) {
    finish(ops);
    if (!standing_ || *standing_ != from) standing_.reset();
    if (to.z < from.z || !standing_) stand_at(to.z < from.z ? to : from, report, ops);
    standing_ = to;  // going up leaves nothing more to cut
    return;
  }
  s.cos = dx / s.length;
  s.sin = dy / s.length;
  s.slope = (to.z - from.z) / s.length;
  s.slope_m = std::sqrt(1 + s.slope * s.slope);
  if (pending_ && pending_->to == from) {
    const double turn = pending_->cos * s.sin - pending_->sin * s.cos;
    const double ahead = pending_->cos * s.cos + pending_->sin * s.sin;
    if (ahead > 0 && std::abs(turn) < kJoinTurn) {
      SweepOp& op = push_strip(ops);
      op.straight_on = std::abs(turn) <= kStraightOn;
      // Straight on and not steeper: the next strip begins where this one ends, or before. (The
      // contact point moves ahead as the slope grows.)
      op.joined = !op.straight_on || s.slope > pending_->slope;
      op.next_cos = s.cos;
      op.next_sin = s.sin;
      op.next_slope = s.slope;
      op.next_m = s.slope_m;
      op.use_double = op.use_double || std::abs(s.slope) > kSlopeForFloat;
      pending_ = s;
      standing_ = from;
      return;
    }
  }
  finish(ops);
  stand_at(from, report, ops);
  pending_ = s;
}

void PathBuilder::add_chords(const CutMove& move, std::uint32_t report, std::vector<SweepOp>& ops) {
  Vec3 from = move.from_mm;
  for (const Vec3& to : arc_chord_points(move, kChordTolerance_mm)) {
    add_segment(from, to, report, ops);
    from = to;
  }
}

void PathBuilder::add_level_arc(const CutMove& move, std::uint32_t report,
                                std::vector<SweepOp>& ops) {
  const std::optional<FlatCircle> circle = flat_circle(move);
  if (!circle) return add_chords(move, report, ops);
  finish(ops);
  const double dz = move.to_mm.z - move.from_mm.z;
  SweepOp op;
  op.report = report;
  op.x = circle->center.x;
  op.y = circle->center.y;
  op.z = move.from_mm.z;
  op.radius = circle->radius;
  set_arc_box(op, *circle);
  const Vec2 start = glm::normalize(circle->start - circle->center),
             end = glm::normalize(circle->end - circle->center);
  if (std::abs(dz) < 1e-9) {
    op.kind = SweepOp::Kind::kArc;
    op.cos = start.x;
    op.sin = start.y;
    op.end_cos = end.x;
    op.end_sin = end.y;
    op.full_circle = circle->sweep_rad >= kFullTurn_rad;
    op.over_half = circle->sweep_rad > kPi;
    op.use_double = circle->radius > kArcReachForFloat_mm;
    ops.push_back(op);
    if (op.full_circle) {
      standing_ = move.to_mm;
      return;
    }
  } else {
    // The kernel's helix descends from its reference end; `over_half` says that it does so
    // clockwise.
    const bool from_start = (dz < 0) != circle->reversed;
    op.kind = SweepOp::Kind::kHelix;
    op.z = std::max(move.from_mm.z, move.to_mm.z);
    op.cos = from_start ? start.x : end.x;
    op.sin = from_start ? start.y : end.y;
    op.over_half = !from_start;
    op.slope = std::abs(dz) / circle->sweep_rad;
    op.length = circle->sweep_rad;
    ops.push_back(op);
  }
  stand_at(move.from_mm, report, ops);
  stand_at(move.to_mm, report, ops);
}

void PathBuilder::add(const CutMove& move, std::uint32_t report, std::vector<SweepOp>& ops) {
  if (move.arc)
    add_level_arc(move, report, ops);
  else
    add_segment(move.from_mm, move.to_mm, report, ops);
}

}  // namespace kerf
