// stock/zmap/sweep_evals.h - the height that an elementary sweep leaves over eight cells. Included
// by sweep_scalar.cpp and sweep_avx2.cpp; the two give the same bits (lanes.h).
//
// A polyline cut strip by strip: the envelope of a path is the lowest of its candidates over each
// cell, and the minimum of a convex function over a segment lies inside or at an end. So a segment
// need only be evaluated where its own contact point lies between its ends (the strip), and a
// vertex where the contact of the segment before lies beyond the vertex and that of the next one
// short of it (the wedge). Nothing is lost, and a dense path touches each cell about once instead
// of once a segment within a tool radius.
//
//        next strip          wedge of the vertex
//          \    \          /
//           \    \________/_
//            \   |          |
//             \  |  strip   |   one tool diameter
//              \ |          |
//               ------------
//
// Rows of blocks are bounded eight at a time, the blocks found are put on a list, and the list is
// worked off in single precision; a lane near a vertical wall, where single precision cannot tell
// inside from outside or loses height, sends its eight cells to the same code in double precision.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including sweep_evals.h"
#endif

#include "stock/zmap/run_list.h"
#include "stock/zmap/tool_lanes.h"

namespace kerf::KERF_LANES_NAMESPACE {

/// A cell centre within this of the cutter's edge counts as inside: makes ties (round numbers in
/// programs and cell sizes) independent of the direction of the move. Far below any machine's
/// resolution, far above double rounding.
constexpr double kEdgeTie_mm = 1e-9;
/// Neighbouring strips overlap by this along the track so that single-precision rounding leaves no
/// gap between them.
constexpr double kStripOverlap_mm = 1e-4;
/// Height error that single precision may cause; half of the 1e-4 mm that kerf promises.
constexpr double kSinglePrecision_mm = 5e-5;
/// Height of a sweep where it does not come: above every blank, finite so that arithmetic stays
/// tame.
constexpr double kNowhere = 1e30;
/// Squared-radius band beside the wall in which single precision is not trusted. `reach` bounds the
/// distances that are compared, `extent` how far a block may lie from where its position was
/// computed in double precision.
inline double unsure_band(const ConvexTool& tool, double steepness, double reach, double extent) {
  const double rounding = 2e-7 * (reach + extent) + 5e-7;
  const double w =
      scalar_min(tool.radius, steepness * tool.radius * rounding / kSinglePrecision_mm);
  return w * w + 4 * tool.radius * rounding;
}

/// What follows a strip: nothing, a strip in the same direction, or one that turns.
enum class Joint { kNone, kStraight, kTurned };

/// Distance from the track within which a strip's cells are so far from the tool's wall that no
/// test against it is needed; negative if there is none. The contact point of a ball keeps away
/// from the equator by w / sqrt(1 + s^2) with w = sqrt(R^2 - v^2), and so does a wedge between two
/// strips in nearly the same direction. Other tools on a slope may touch with their rim anywhere;
/// on the level, any tool touches beside its axis.
inline double interior_width(const SweepContext& c) {
  const SweepOp& op = c.op;
  const bool level = op.slope == 0 && (!op.joined || op.next_slope == 0);
  if (c.tool.kind != ConvexTool::Kind::kBall && !level) return -1;
  double steepest = op.slope_m, turn = 0;
  if (op.joined) {
    steepest = scalar_max(steepest, op.next_m);
    turn = op.straight_on ? 0.0 : scalar_abs(op.cos * op.next_sin - op.sin * op.next_cos);
  }
  const double r2 = c.tool.radius * c.tool.radius;
  const double band = unsure_band(c.tool, op.slope_m, c.tool.radius, c.extent());
  const double needed = steepest * steepest * (band + 2 * r2 * turn * (1 + turn)) + 1e-3 * r2;
  const double half_block = kHalfX * c.grid.cell_x * scalar_abs(op.sin) +
                            kHalfY * c.grid.cell_y * scalar_abs(op.cos) + 1e-3;
  return needed < r2 ? scalar_sqrt(r2 - needed) - half_block : -1;
}

template <class T, class Shape, Joint kJoint>
struct StripEval {
  static constexpr bool kRowsAlike = true;  ///< most of the work depends on v alone
  using S = typename T::Scalar;
  using Mask = typename T::Mask;
  static constexpr bool kDouble = sizeof(S) == sizeof(double);
  Shape shape, next;
  bool edges;
  T radius2, tie, overlap, length, length_over, band, turn_cos, turn_sin, vertex_z, edge_band;

  static T all(double x) { return T::all(static_cast<S>(x)); }
  StripEval(const ConvexTool& tool, const SweepOp& op, double extent = 0)
      : shape(tool, {op.slope, op.slope_m}),
        next(tool, {op.next_slope, op.next_m}),
        // The contact reaches the wall: the strip then begins or ends in a step that must be placed
        // exactly.
        edges(op.slope != 0 && scalar_abs(op.slope) >= tool.wall_slope),
        radius2(all(tool.radius * tool.radius)),
        tie(all(kDouble ? -2 * tool.radius * kEdgeTie_mm : 0.0)),
        overlap(all(kDouble ? -kEdgeTie_mm : -kStripOverlap_mm)),
        length(all(op.length)),
        length_over(all(op.length + (kDouble ? kEdgeTie_mm : kStripOverlap_mm))),
        band(all(unsure_band(tool, op.slope_m, tool.radius, extent))),
        turn_cos(all(op.cos * op.next_cos + op.sin * op.next_sin)),
        turn_sin(all(op.cos * op.next_sin - op.sin * op.next_cos)),
        vertex_z(all(op.z + op.slope * op.length)),
        edge_band(all(2 * kStripOverlap_mm)) {}

  /// Heights; kNowhere where the strip does not come. `unsure` where only double precision can
  /// tell. kInterior: for blocks within interior_width(), always sure.
  template <bool kInterior>
  T at(T u, T v, T track, Mask& unsure) const {
    const T v2 = v * v;
    unsure = all(0) > all(0);
    const ContactLanes<T> contact = shape.contact(track, v2, unsure);
    const T t = u - contact.rho;
    const Mask in_track = (t >= overlap) & (t <= length_over);
    Mask inside = in_track;
    if constexpr (!kInterior) {
      const T w2 = radius2 - v2;
      inside = (w2 >= tie) & in_track;
      if constexpr (!kDouble) flag_walls(t, w2, in_track, unsure);
    }
    const T z = select(inside, contact.z, all(kNowhere));
    if constexpr (kJoint == Joint::kNone) return z;
    return min(z, wedge<kInterior>(u, v, v2, t, contact, unsure));
  }

 private:
  void flag_walls(T t, T w2, Mask in_track, Mask& unsure) const {
    unsure = in_track & (unsure | (abs(w2) <= band));
    if (Shape::kMayHaveEdges && edges) {
      const Mask at_end = (abs(t) <= edge_band) | (abs(t - length) <= edge_band);
      unsure = unsure | (at_end & (w2 >= all(0) - band));
    }
  }

  /// The tool standing at the end of the strip, over the cells between this strip and the next.
  template <bool kInterior>
  T wedge(T u, T v, T v2, T t, const ContactLanes<T>& contact, Mask& unsure) const {
    const T a = u - length;
    Mask unsure_next = all(0) > all(0);
    T u_next = a, rho;
    if constexpr (kJoint == Joint::kTurned) {
      u_next = a * turn_cos + v * turn_sin;
      const T v_next = v * turn_cos - a * turn_sin;
      rho = next.contact(all(0), v_next * v_next, unsure_next).rho;
    } else {
      rho = next.rho_like(contact, v2, unsure_next);
    }
    Mask between = (t >= length + overlap) & (u_next - rho <= all(0) - overlap);
    // Narrow where a path is smooth: most blocks have none of it, and need no root.
    if (!any(between)) [[likely]]
      return all(kNowhere);
    const T d2 = a * a + v2;
    if constexpr (!kInterior) {
      const T w2 = radius2 - d2;
      if constexpr (!kDouble) unsure = unsure | (between & (unsure_next | (abs(w2) <= band)));
      between = between & (w2 >= tie);
    }
    return select(between, vertex_z + shape.surface(d2), all(kNowhere));
  }
};

template <class T, class Shape>
struct CapEval {
  static constexpr bool kRowsAlike = false;
  using S = typename T::Scalar;
  using Mask = typename T::Mask;
  static constexpr bool kDouble = sizeof(S) == sizeof(double);
  Shape shape;
  T radius2, tie, tip_z, band;
  static T all(double x) { return T::all(static_cast<S>(x)); }
  CapEval(const ConvexTool& tool, const SweepOp& op, double extent = 0)
      : shape(tool, {}),
        radius2(all(tool.radius * tool.radius)),
        tie(all(kDouble ? -2 * tool.radius * kEdgeTie_mm : 0.0)),
        tip_z(all(op.z)),
        band(all(unsure_band(tool, 1.0, tool.radius, extent))) {}
  template <bool kInterior>
  T at(T x, T y, T, Mask& unsure) const {
    const T d2 = x * x + y * y;
    unsure = all(0) > all(0);
    const T z = tip_z + shape.surface(d2);
    if constexpr (kInterior) return z;
    const T w2 = radius2 - d2;
    if constexpr (!kDouble) unsure = abs(w2) <= band;
    return select(w2 >= tie, z, all(kNowhere));
  }
};

template <class T, class Shape>
struct ArcEval {
  static constexpr bool kRowsAlike = false;
  using S = typename T::Scalar;
  using Mask = typename T::Mask;
  static constexpr bool kDouble = sizeof(S) == sizeof(double);
  Shape shape;
  bool full, over_half;
  T radius2, tie, tip_z, band, path, cos0, sin0, cos1, sin1, overlap;
  static T all(double x) { return T::all(static_cast<S>(x)); }
  ArcEval(const ConvexTool& tool, const SweepOp& op, double extent = 0)
      : shape(tool, {}),
        full(op.full_circle),
        over_half(op.over_half),
        radius2(all(tool.radius * tool.radius)),
        tie(all(kDouble ? -2 * tool.radius * kEdgeTie_mm : 0.0)),
        tip_z(all(op.z)),
        band(all(unsure_band(tool, 1.0, tool.radius + op.radius, extent))),
        path(all(op.radius)),
        cos0(all(op.cos)),
        sin0(all(op.sin)),
        cos1(all(op.end_cos)),
        sin1(all(op.end_sin)),
        overlap(all(kDouble ? -kEdgeTie_mm : -kStripOverlap_mm)) {}
  template <bool kInterior>
  T at(T x, T y, T, Mask& unsure) const {
    const T d = sqrt(x * x + y * y) - path;
    const T d2 = d * d;
    unsure = all(0) > all(0);
    const T z = tip_z + shape.surface(d2);
    if constexpr (kInterior) return z;
    const T w2 = radius2 - d2;
    Mask inside = w2 >= tie;
    Mask near = abs(w2) <= band;
    if (!full) {
      const Mask after_start = cos0 * y - sin0 * x >= overlap;
      const Mask before_end = x * sin1 - y * cos1 >= overlap;
      const Mask between = over_half ? (after_start | before_end) : (after_start & before_end);
      inside = inside & between;
      near = near & between;
    }
    if constexpr (!kDouble) unsure = near;
    return select(inside, z, all(kNowhere));
  }
};

}  // namespace kerf::KERF_LANES_NAMESPACE
