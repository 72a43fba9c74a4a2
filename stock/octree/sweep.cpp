#include "stock/octree/sweep.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/mesh_patch.h"
#include "base/portable_math.h"

namespace kerf::octree {
namespace {

/// Lengths below this are none, mm. Far below what a crossing can hold.
constexpr double kNothing_mm = 1e-9;
/// Spindle directions this close are one, rad: 1 nm in 10 m.
constexpr double kNoTurn_rad = 1e-10;
constexpr Vec3 kUp{0, 0, 1};

double turned_rad(const CutMove& move) {
  return portable::atan2(glm::length(glm::cross(move.axis_from, move.axis_to)),
                         glm::dot(move.axis_from, move.axis_to));
}

/// Along the great circle; only of a move that turns.
Vec3 turned_axis(const CutMove& move, double part) {
  const double angle = part * turned_rad(move);
  const Vec3 across =
      glm::normalize(move.axis_to - glm::dot(move.axis_from, move.axis_to) * move.axis_from);
  return portable::cos(angle) * move.axis_from + portable::sin(angle) * across;
}

std::uint32_t cut_id_of(std::uint64_t id) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(id, MeshPatch::kNotCut - 1));
}

/// Any unit vector square to w. For w = z it is x, exactly.
Vec3 any_across(const Vec3& w) {
  const Vec3 start = std::abs(w.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return glm::normalize(start - glm::dot(start, w) * w);
}

void extend(Box& box, const Vec3& tip, const Vec3& w, const ToolBody& body, double top) {
  box.extend(tip + body.low_mm * w);
  box.extend(tip + std::max(body.low_mm, top) * w);
}

/// Height above the tip beyond which the body is out of `bounds`.
double reach_above(const Box& bounds, const Vec3& tip, const Vec3& w, const ToolBody& body) {
  if (!body.endless) return body.top_mm;
  double reach = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                 corner & 4 ? bounds.max.z : bounds.min.z};
    reach = std::max(reach, glm::dot(p - tip, w));
  }
  return reach;
}

/// Sets box_mm; false if the sweep misses `bounds`.
bool bound(Sweep& sweep, Box box, double margin, const Box& bounds) {
  margin += sweep.body->radius_mm + kNothing_mm;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::max(box.min[axis] - margin, bounds.min[axis]);
    box.max[axis] = std::min(box.max[axis] + margin, bounds.max[axis]);
  }
  sweep.box_mm = box;
  return !box.empty();
}

/// Of a ball nose or a sphere, above the tip.
double centre_above(const ToolBody& body) {
  return body.shape == ToolBody::Shape::kGeneral ? 0 : body.elements[0].center_z;
}

void set_step(Sweep& sweep, const Vec3& step) {
  sweep.step = step;
  const double step2 = glm::dot(step, step);
  sweep.per_step2 = step2 > 0 ? 1 / step2 : 0;
}

void add_straight(const ToolBody& body, const Vec3& from, const Vec3& to, const Vec3& w,
                  Sweep sweep, const Box& bounds, std::vector<Sweep>& out) {
  const Vec3 step = to - from;
  const double rise = glm::dot(step, w);
  const Vec3 level = step - rise * w;
  const double run = glm::length(level);
  sweep.body = &body;
  sweep.origin_above_mm = centre_above(body);
  sweep.origin_mm = from + sweep.origin_above_mm * w;
  sweep.w = w;
  sweep.u = run > kNothing_mm ? level / run : any_across(w);
  sweep.v = glm::cross(w, sweep.u);
  sweep.length_u = run > kNothing_mm ? run : 0;
  sweep.length_w = std::abs(rise) > kNothing_mm ? rise : 0;
  if (sweep.length_u == 0 && sweep.length_w != 0 && body.endless) {
    // Straight along the spindle an endless tool takes away what it takes at the lower end.
    sweep.origin_mm += std::min(0.0, rise) * w;
    sweep.length_w = 0;
  }
  set_step(sweep, sweep.length_u * sweep.u + sweep.length_w * w);
  if (body.shape == ToolBody::Shape::kSphere)
    sweep.kind = Sweep::Kind::kSphere;
  else if (body.shape == ToolBody::Shape::kBall)
    sweep.kind = Sweep::Kind::kBall;
  else
    sweep.kind = sweep.length_w == 0 ? Sweep::Kind::kLevel : Sweep::Kind::kRamp;
  Box box;
  extend(box, from, w, body, reach_above(bounds, from, w, body));
  extend(box, to, w, body, reach_above(bounds, to, w, body));
  if (w == kUp) sweep.bottom_mm = std::min(from.z, to.z) + body.low_mm;
  if (bound(sweep, box, 0, bounds)) out.push_back(sweep);
}

/// The frame of the way from `step`, with the spindle half way between w0 and w1.
void set_mean(Sweep& piece, const Vec3& w0, const Vec3& w1) {
  piece.mean_w = glm::normalize(w0 + w1);
  piece.length_w = glm::dot(piece.step, piece.mean_w);
  const Vec3 level = piece.step - piece.length_w * piece.mean_w;
  piece.length_u = glm::length(level);
  piece.u = piece.length_u > kNothing_mm ? level / piece.length_u : any_across(piece.mean_w);
  piece.v = glm::cross(piece.mean_w, piece.u);
  // Directions between them go along the chord: none is farther from the middle than the ends.
  piece.off_rad = std::max(glm::length(w0 - piece.mean_w), glm::length(w1 - piece.mean_w)) *
                  (1 + kTurnPiece_rad);
}

void add_turning(const ToolBody& body, const CutMove& move, Sweep sweep, const SweepTarget& target,
                 std::vector<Sweep>& out) {
  const Box& bounds = target.bounds_mm;
  const double angle = turned_rad(move);
  const double length = glm::length(move.to_mm - move.from_mm);
  const double farthest = std::max(reach_above(bounds, move.from_mm, move.axis_from, body),
                                   reach_above(bounds, move.to_mm, move.axis_to, body)) +
                          body.radius_mm;
  const double above = centre_above(body);
  // The centre's way is no longer than the tip's and what it turns.
  const double bend = bend_mm(farthest, length + above * angle, angle);
  const double needed = std::max(angle / kTurnPiece_rad, std::sqrt(bend / target.chord_mm));
  const int pieces = std::max(1, static_cast<int>(std::ceil(needed)));
  const auto axis_at = [&](int i) { return turned_axis(move, static_cast<double>(i) / pieces); };
  const auto tip_at = [&](int i) {
    return move.from_mm + (static_cast<double>(i) / pieces) * (move.to_mm - move.from_mm);
  };
  for (int i = 0; i < pieces; ++i) {
    const Vec3 tip0 = tip_at(i), tip1 = tip_at(i + 1), w0 = axis_at(i), w1 = axis_at(i + 1);
    Sweep piece = sweep;
    piece.kind = body.shape == ToolBody::Shape::kSphere ? Sweep::Kind::kSphere : Sweep::Kind::kTurn;
    piece.body = &body;
    piece.origin_above_mm = above;
    piece.origin_mm = tip0 + above * w0;
    piece.w = w0;
    set_step(piece, tip1 + above * w1 - piece.origin_mm);
    piece.turn = w1 - w0;
    set_mean(piece, w0, w1);
    const double reach =
        std::max(reach_above(bounds, tip0, w0, body), reach_above(bounds, tip1, w1, body)) *
        (1 + kTurnPiece_rad);
    Box box;
    extend(box, tip0, w0, body, reach);
    extend(box, tip1, w1, body, reach);
    piece.bend_mm = bend_mm(reach + body.radius_mm, glm::length(piece.step), angle / pieces);
    // A point at `reach` bulges out from between its ends by a sagitta, a ball's centre not at all.
    const double sagitta = (reach + above) * kTurnPiece_rad * kTurnPiece_rad / 8;
    if (bound(piece, box, sagitta, bounds)) out.push_back(piece);
  }
}

struct ArcFrame {
  Vec3 u, v;  ///< from the centre to the start, and square to it in the sense of turning
  double r0, r1, rise0, rise1;
};

ArcFrame frame_of(const CutMove& move) {
  const CutArc& arc = *move.arc;
  const Vec3 from = move.from_mm - arc.center_mm, to = move.to_mm - arc.center_mm;
  ArcFrame f{};
  f.rise0 = glm::dot(from, arc.axis);
  f.rise1 = glm::dot(to, arc.axis);
  const Vec3 out0 = from - f.rise0 * arc.axis;
  f.r0 = glm::length(out0);
  f.r1 = glm::length(to - f.rise1 * arc.axis);
  f.u = f.r0 > kNothing_mm ? out0 / f.r0 : any_across(arc.axis);
  f.v = glm::cross(arc.axis, f.u);
  return f;
}

Vec3 arc_point(const CutMove& move, const ArcFrame& f, double s) {
  if (s <= 0) return move.from_mm;
  if (s >= 1) return move.to_mm;
  const double angle = s * move.arc->sweep_rad;
  return move.arc->center_mm +
         (f.r0 + s * (f.r1 - f.r0)) * (portable::cos(angle) * f.u + portable::sin(angle) * f.v) +
         (f.rise0 + s * (f.rise1 - f.rise0)) * move.arc->axis;
}

/// An arc that turns about the spindle's direction and stays level, within `tolerance`.
bool is_level_arc(const CutMove& move, const ArcFrame& f, double tolerance) {
  return glm::length(glm::cross(move.arc->axis, move.axis_from)) < 1e-12 &&
         std::abs(f.rise1 - f.rise0) < kNothing_mm && std::abs(f.r1 - f.r0) <= tolerance;
}

void add_level_arc(const ToolBody& body, const CutMove& move, const ArcFrame& f, Sweep sweep,
                   const Box& bounds, std::vector<Sweep>& out) {
  const CutArc& arc = *move.arc;
  const double half = std::min(kPi, std::abs(arc.sweep_rad) / 2);
  const double middle = arc.sweep_rad / 2;
  sweep.kind = Sweep::Kind::kArc;
  sweep.body = &body;
  sweep.w = move.axis_from;
  sweep.origin_mm = arc.center_mm + f.rise0 * arc.axis;
  sweep.u = portable::cos(middle) * f.u + portable::sin(middle) * f.v;
  sweep.v = glm::cross(sweep.w, sweep.u);
  sweep.arc_radius = (f.r0 + f.r1) / 2;
  // A full circle has no ends: every direction is within it.
  sweep.cos_half = half > kPi - 1e-12 ? -2 : portable::cos(half);
  sweep.end_u = sweep.arc_radius * portable::cos(half);
  sweep.end_v = sweep.arc_radius * portable::sin(half);
  Box box;
  extend(box, sweep.origin_mm, sweep.w, body, reach_above(bounds, sweep.origin_mm, sweep.w, body));
  if (sweep.w == kUp) sweep.bottom_mm = sweep.origin_mm.z + body.low_mm;
  if (bound(sweep, box, sweep.arc_radius, bounds)) out.push_back(sweep);
}

int chords_of(const CutMove& move, const ArcFrame& f, double tolerance) {
  const double radius = std::max({f.r0, f.r1, tolerance});
  const double step = 2 * portable::acos(std::max(0.0, 1 - tolerance / radius));
  return std::max(1, static_cast<int>(std::ceil(std::abs(move.arc->sweep_rad) / step)));
}

}  // namespace

double bend_mm(double reach_mm, double step_mm, double turn_rad) {
  return reach_mm * turn_rad * turn_rad / 8 + step_mm * turn_rad / 4;
}

double chord_mm(double cell_mm) { return std::min(cell_mm / 50, 0.002); }

void append_sweeps(const std::vector<ToolBody>& bodies, const CutMove& move, std::uint32_t report,
                   const SweepTarget& target, std::vector<Sweep>& out) {
  assert(!move.arc || move.axis_from == move.axis_to);
  Sweep sweep;
  sweep.report = report;
  sweep.cut_id = cut_id_of(move.id);
  sweep.shrink_mm = target.shrink_mm;
  const Box& bounds = target.bounds_mm;
  if (turned_rad(move) > kNoTurn_rad) {
    for (const ToolBody& body : bodies) add_turning(body, move, sweep, target, out);
    return;
  }
  if (!move.arc) {
    for (const ToolBody& body : bodies)
      add_straight(body, move.from_mm, move.to_mm, move.axis_from, sweep, bounds, out);
    return;
  }
  const ArcFrame f = frame_of(move);
  if (is_level_arc(move, f, target.chord_mm)) {
    for (const ToolBody& body : bodies) add_level_arc(body, move, f, sweep, bounds, out);
    return;
  }
  const int chords = chords_of(move, f, target.chord_mm);
  for (int i = 0; i < chords; ++i) {
    const Vec3 from = arc_point(move, f, static_cast<double>(i) / chords);
    const Vec3 to = arc_point(move, f, static_cast<double>(i + 1) / chords);
    for (const ToolBody& body : bodies)
      add_straight(body, from, to, move.axis_from, sweep, bounds, out);
  }
}

CutMove first_part(const CutMove& move, double part) {
  CutMove first = move;
  if (move.arc) {
    first.to_mm = arc_point(move, frame_of(move), part);
    first.arc->sweep_rad = part * move.arc->sweep_rad;
    return first;
  }
  first.to_mm = move.from_mm + part * (move.to_mm - move.from_mm);
  if (turned_rad(move) > kNoTurn_rad) first.axis_to = turned_axis(move, part);
  return first;
}

CutMove middle_part(const CutMove& move, double from, double to) {
  CutMove middle = first_part(move, to);
  const CutMove before = first_part(move, from);
  middle.from_mm = before.to_mm;
  middle.axis_from = before.axis_to;
  if (move.arc) middle.arc->sweep_rad = (to - from) * move.arc->sweep_rad;
  return middle;
}

}  // namespace kerf::octree
