#include "twin/motion/motion_geometry.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "interp_bridge/timing/planner.h"

namespace kerf {
namespace {

/// The two ends of an arc, taken apart into height along the axis and the vector across it.
struct ArcEnds {
  double along0 = 0, along1 = 0;
  Vec3 across0{0}, across1{0};
  double r0 = 0, r1 = 0;
};

ArcEnds arc_ends(const Motion& m) {
  ArcEnds ends;
  const Vec3 d0 = m.from_mm - m.arc.center_mm;
  const Vec3 d1 = m.to_mm - m.arc.center_mm;
  ends.along0 = glm::dot(d0, m.arc.axis);
  ends.along1 = glm::dot(d1, m.arc.axis);
  ends.across0 = d0 - ends.along0 * m.arc.axis;
  ends.across1 = d1 - ends.along1 * m.arc.axis;
  ends.r0 = glm::length(ends.across0);
  ends.r1 = glm::length(ends.across1);
  return ends;
}

}  // namespace

Motion as_programmed(const Motion& motion) {
  Motion out = motion;
  out.length = {};
  if (!motion.length.displaces) return out;
  const Vec3 shift_mm = motion.length.tip_shift_mm;
  out.from_mm -= shift_mm;
  out.to_mm -= shift_mm;
  out.from_uvw_mm -= motion.length.uvw_off_mm;
  out.to_uvw_mm -= motion.length.uvw_off_mm;
  out.tool_offset_mm += motion.length.applied_mm - motion.length.real_mm;
  out.tool_offset_uvw_mm += motion.length.uvw_off_mm;
  if (out.kind == MotionKind::kArc) out.arc.center_mm -= shift_mm;
  out.surface.axis_x_mm -= shift_mm.x;
  return out;
}

double path_length_mm(const Motion& m) {
  if (m.kind != MotionKind::kArc) return glm::length(m.to_mm - m.from_mm);
  const ArcEnds ends = arc_ends(m);
  const double around = 0.5 * (ends.r0 + ends.r1) * m.arc.sweep_rad;
  const double along = ends.along1 - ends.along0;
  const double outward = ends.r1 - ends.r0;
  return std::sqrt(around * around + along * along + outward * outward);
}

double fed_length_mm(const Motion& m) {
  const double way_mm = path_length_mm(m);
  return way_mm > 0 ? way_mm : glm::length(m.to_uvw_mm - m.from_uvw_mm);
}

Vec3 point_at(const Motion& m, double t) {
  if (m.kind != MotionKind::kArc) return m.from_mm + t * (m.to_mm - m.from_mm);
  const ArcEnds ends = arc_ends(m);
  const double along = ends.along0 + t * (ends.along1 - ends.along0);
  if (ends.r0 <= 0) return m.arc.center_mm + along * m.arc.axis + t * ends.across1;
  const Vec3 u = ends.across0 / ends.r0;
  const Vec3 v = glm::cross(m.arc.axis, u);
  const double radius = ends.r0 + t * (ends.r1 - ends.r0);
  const double angle = t * m.arc.sweep_rad;
  return m.arc.center_mm + along * m.arc.axis +
         radius * (portable::cos(angle) * u + portable::sin(angle) * v);
}

Box bounds_of(const Motion& m) {
  Box box;
  box.extend(m.to_mm);
  if (!m.start_known) return box;
  box.extend(m.from_mm);
  if (m.kind != MotionKind::kArc) return box;
  const ArcEnds ends = arc_ends(m);
  if (ends.r0 <= 0) return box;
  const double radius = std::max(ends.r0, ends.r1);
  const Vec3 u = ends.across0 / ends.r0;
  const Vec3 v = glm::cross(m.arc.axis, u);
  const double turn = m.arc.sweep_rad < 0 ? -1.0 : 1.0;
  for (int i = 0; i < 3; ++i) {
    // Coordinate i of the circle is greatest at this angle from the start, and least half a turn
    // on.
    const double reach = radius * portable::hypot(u[i], v[i]);
    const double greatest = portable::atan2(v[i], u[i]);
    for (const double sign : {1.0, -1.0}) {
      double angle = turn * (sign > 0 ? greatest : greatest + kPi);
      angle -= 2 * kPi * std::floor(angle / (2 * kPi));
      if (angle > std::abs(m.arc.sweep_rad)) continue;
      for (const double along : {ends.along0, ends.along1}) {
        const double place = m.arc.center_mm[i] + along * m.arc.axis[i] + sign * reach;
        box.min[i] = std::min(box.min[i], place);
        box.max[i] = std::max(box.max[i], place);
      }
    }
  }
  return box;
}

bool stands_still(const Motion& m) {
  const bool turns = m.kind == MotionKind::kArc && m.arc.sweep_rad != 0;
  return !turns && m.from_mm == m.to_mm && m.from_abc_deg == m.to_abc_deg &&
         m.from_uvw_mm == m.to_uvw_mm;
}

bool moves_sideways(const Motion& m) {
  if (m.kind == MotionKind::kArc && m.arc.sweep_rad != 0) return true;
  return m.from_mm.x != m.to_mm.x || m.from_mm.y != m.to_mm.y;
}

double lead_mm_of(const Motion& m) {
  if (m.kind != MotionKind::kThread || m.spindle == SpindleState::kStopped) return 0;
  return m.spindle == SpindleState::kClockwise ? m.feed_mm_per_min : -m.feed_mm_per_min;
}

void set_cut_move(CutMove& move, const Motion& m, std::uint64_t id) {
  move.from_mm = m.from_mm;
  move.to_mm = m.to_mm;
  if (m.kind == MotionKind::kArc) {
    move.arc = CutArc{m.arc.center_mm, m.arc.axis, m.arc.sweep_rad};
  } else {
    move.arc.reset();
  }
  move.axis_from = move.axis_to = {0, 0, 1};
  move.lead_mm = lead_mm_of(m);
  move.id = id;
}

CutMove cut_move_from(const Motion& m, std::uint64_t id) {
  CutMove move;
  set_cut_move(move, m, id);
  return move;
}

Motion motion_of(const Motion& motion, const PathPiece& piece) {
  Motion moved = motion;
  if (piece.curved) {
    moved.kind = MotionKind::kArc;
    moved.rapid = motion.kind == MotionKind::kTraverse;
  } else if (motion.kind == MotionKind::kArc) {
    moved.kind = MotionKind::kFeed;
  }
  moved.from_mm = piece.from_mm;
  moved.to_mm = piece.to_mm;
  moved.arc = piece.arc;
  return moved;
}

}  // namespace kerf
