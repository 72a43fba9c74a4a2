// stock/zmap/sweep_walk.h - which blocks a sweep can touch, and the loop over sweeps. Included
// after sweep_kernel.h.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including sweep_walk.h"
#endif

#include "stock/zmap/helix_eval.h"
#include "stock/zmap/work_off.h"

namespace kerf::KERF_LANES_NAMESPACE {

/// Clips [low, high] to the x with lo <= a*x + b <= hi, given ia = 1/a (or +-1e6 where a is about
/// 0).
inline void clip(F8 ia, F8 b, F8 lo, F8 hi, F8& low, F8& high) {
  const F8 p = (lo - b) * ia, q = (hi - b) * ia;
  low = max(low, min(p, q));
  high = min(high, max(p, q));
}
inline float inverse_or_huge(double a) {
  if (scalar_abs(a) < 1e-6) return a < 0 ? -1e6f : 1e6f;
  return static_cast<float>(1 / a);
}

/// How far from the axis a tool can touch on slope s, as a signed bound of rho; `ball_like` if rho
/// = factor * sqrt(R^2 - v^2).
struct ContactReach {
  float factor = 0;
  bool circular = false;
};
inline ContactReach contact_reach(const ConvexTool& tool, double slope, double m) {
  const double sign = slope > 0 ? 1 : slope < 0 ? -1 : 0;
  if (tool.kind == ConvexTool::Kind::kFlat) return {static_cast<float>(sign), true};
  if (tool.kind == ConvexTool::Kind::kBall) return {static_cast<float>(slope / m), true};
  return {static_cast<float>(sign), false};
}

/// Bounds of u over the cells of a strip, for eight block rows: see sweep_kernel.h for the shape.
struct StripBounds {
  float lower, upper;    ///< of u over the whole strip, half a block included
  float half_u, half_v;  ///< half extent of a block in the strip's frame
  float radius, length, wedge_extra;
  ContactReach reach, next_reach;
  bool joined;
  float turn;

  [[gnu::always_inline]] explicit StripBounds(const SweepContext& c)
      : radius(static_cast<float>(c.tool.radius)),
        length(static_cast<float>(c.op.length)),
        joined(c.op.joined) {
    const SweepOp& op = c.op;
    half_u = static_cast<float>(kHalfX * c.grid.cell_x * scalar_abs(op.cos) +
                                kHalfY * c.grid.cell_y * scalar_abs(op.sin)) +
             kBoundSlack_mm;
    half_v = static_cast<float>(kHalfX * c.grid.cell_x * scalar_abs(op.sin) +
                                kHalfY * c.grid.cell_y * scalar_abs(op.cos)) +
             kBoundSlack_mm;
    reach = contact_reach(c.tool, op.slope, op.slope_m);
    next_reach = contact_reach(c.tool, joined ? op.next_slope : 0.0, op.next_m);
    turn = static_cast<float>(scalar_abs(op.cos * op.next_sin - op.sin * op.next_cos));
    wedge_extra = joined ? 1.05f * radius * turn : 0.0f;
    lower = (reach.factor < 0 ? reach.factor * radius : 0.0f) - half_u;
    const float ahead = reach.factor > 0 ? reach.factor * radius : 0.0f;
    const float ahead_next = next_reach.factor > 0 ? 1.05f * next_reach.factor * radius : 0.0f;
    upper = length +
            (joined && ahead_next + wedge_extra > ahead ? ahead_next + wedge_extra : ahead) +
            half_u;
  }

  /// Tighter bounds for rows whose blocks lie between v_low and v_high from the track.
  [[gnu::always_inline]] void tighten(F8 v_near, F8 v_far, F8& u_low, F8& u_high) const {
    const F8 zero = F8::all(0), r2 = F8::all(radius * radius);
    const F8 w_wide = sqrt(max(r2 - v_near * v_near, zero));
    const F8 w_slim = reach.circular ? sqrt(max(r2 - v_far * v_far, zero)) : zero;
    const F8 f = F8::all(reach.factor);
    const F8 wide = reach.circular ? w_wide : F8::all(radius);
    const F8 a = f * wide, b = f * w_slim;
    u_low = min(a, b) - F8::all(half_u);
    u_high = max(a, b) + F8::all(length);
    if (joined) {
      const F8 v_next = max(F8::all(0.95f) * v_near - F8::all(radius * turn), zero);
      const F8 w_next =
          next_reach.circular ? sqrt(max(r2 - v_next * v_next, zero)) : F8::all(radius);
      const float ahead = next_reach.factor > 0 ? 1.05f * next_reach.factor : 0.0f;
      u_high = max(u_high, F8::all(ahead) * w_next + F8::all(length + wedge_extra));
    }
    u_high = u_high + F8::all(half_u);
  }
};

/// Gives `out` every run of blocks that the strip can touch. Positions are taken from the block in
/// which the strip starts, so that they stay small.
[[gnu::noinline]] inline void walk_strip(const SweepContext& c, RunWriter& out) {
  const SweepOp& op = c.op;
  const GridView& g = c.grid;
  const StripBounds bounds(c);
  const double block_x = kBlockX * g.cell_x, block_y = kBlockY * g.cell_y;
  const int home_i = floor_int((op.x - g.x0) * g.per_block_x);
  const int home_j = floor_int((op.y - g.y0) * g.per_block_y);
  const double ax = op.x - g.x0 - home_i * block_x, ay = op.y - g.y0 - home_j * block_y;
  const auto all = [](double v) { return F8::all(static_cast<float>(v)); };
  const F8 cos = all(op.cos), sin = all(op.sin), zero = F8::all(0), radius = F8::all(bounds.radius);
  const F8 icos = F8::all(inverse_or_huge(op.cos)), isin = F8::all(inverse_or_huge(-op.sin));
  const F8 side = F8::all(bounds.radius + bounds.half_v), half_v = F8::all(bounds.half_v);
  const F8 first_column = all(-home_i), last_column = all((g.nx - 1) / kBlockX - home_i);
  const bool is_short = c.is_short();
  alignas(32) static constexpr float kLane[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  for (int first = c.first_row; first <= c.last_row; first += 8) {
    const F8 row = F8::all(static_cast<float>(first - home_j)) + F8::load(kLane);
    const F8 y = row * all(block_y) + all(0.5 * block_y - ay);
    const F8 y_sin = y * sin, y_cos = y * cos;
    F8 low = F8::all(-1e9f), high = F8::all(1e9f);
    clip(icos, y_sin, F8::all(bounds.lower), F8::all(bounds.upper), low, high);
    clip(isin, y_cos, zero - side, side, low, high);
    const F8 v1 = y_cos - low * sin, v2 = y_cos - high * sin;
    const F8 v_min = min(v1, v2) - half_v, v_max = max(v1, v2) + half_v;
    const F8 v_far = min(radius, max(zero - v_min, v_max));
    const F8 v_near = min(radius, max(zero, max(v_min, zero - v_max)));
    F8 u_low, u_high;
    bounds.tighten(v_near, v_far, u_low, u_high);
    clip(icos, y_sin, u_low, u_high, low, high);
    // Block columns, relative to home_i: centres between low and high.
    const F8 to_block = all(g.per_block_x), shift = all(ax * g.per_block_x - 0.5);
    const F8 begin = zero - floor(zero - max(low * to_block + shift, first_column));
    const F8 end = floor(max(min(high * to_block + shift, last_column), first_column - F8::all(1)));
    const F8 x0 = min(begin, last_column) * all(block_x) + all(0.5 * g.cell_x - ax);
    const F8 y0 = row * all(block_y) + all(0.5 * g.cell_y - ay);
    const F8 p0 = x0 * cos + y0 * sin;
    const F8 q0 = y0 * cos - x0 * sin, count = end - begin + F8::all(1);
    const F8 q_first = q0 + F8::all(out.to_center());
    const F8 q_last = q_first + (count - F8::all(1)) * F8::all(out.step_q());
    const unsigned interior = bits(max(abs(q_first), abs(q_last)) <= F8::all(out.interior()));
    unsigned rows =
        bits(count > zero) & ((2u << (c.last_row - first < 7 ? c.last_row - first : 7)) - 1);
    alignas(32) float begins[8], counts[8], starts[32];
    store(begins, begin + F8::all(static_cast<float>(home_i)));
    store(counts, count);
    store_rows(starts, p0, q0, all(op.z) + all(op.slope) * p0);
    if (is_short) out.make_room();
    for (; rows != 0; rows &= rows - 1) {
      const int lane = __builtin_ctz(rows);
      const int b0 = static_cast<int>(begins[lane]), n = static_cast<int>(counts[lane]);
      if (is_short)
        out.add_short(first + lane, b0, n, starts + 4 * lane, (interior >> lane & 1) != 0);
      else
        out.add(first + lane, b0, b0 + n - 1);
    }
  }
}

/// What a cap or an arc covers about its centre: between two radii, and safely (no test against the
/// wall is needed) between two others; safe_outer < 0 if nowhere.
struct Ring {
  double inner = 0, outer = 0;
  double safe_inner = 0, safe_outer = -1;
};

inline Ring ring_of(const SweepContext& c) {
  const SweepOp& op = c.op;
  const bool cap = op.kind == SweepOp::Kind::kCap;
  const double path = cap ? 0.0 : op.radius, r = c.tool.radius;
  Ring ring{cap ? 0.0 : path - r, path + r, 0, -1};
  if (op.use_double || !(cap || (op.kind == SweepOp::Kind::kArc && op.full_circle))) return ring;
  const double safe2 = r * r - unsure_band(c.tool, 1.0, r + path, c.extent());
  if (safe2 <= 0) return ring;
  const double safe = scalar_sqrt(safe2) - kBoundSlack_mm;
  ring.safe_outer = path + safe;
  ring.safe_inner = path - safe;
  return ring;
}

/// Half the chord of a circle at distance y from its centre, 0 where there is none.
inline double half_chord(double radius, double y) {
  return radius > y ? scalar_sqrt(radius * radius - y * y) : 0.0;
}

/// Rows of blocks of a ring, within the box of the sweep's path widened by the tool's radius.
[[gnu::noinline]] inline void walk_ring(const SweepContext& c, const Ring& ring, RunWriter& out) {
  const GridView& g = c.grid;
  const double margin = c.tool.radius + 1e-3;
  const double left = c.op.min_x - margin - c.op.x, right = c.op.max_x + margin - c.op.x;
  const double half_x = kHalfX * g.cell_x, half_y = kHalfY * g.cell_y;
  const int last_column = (g.nx - 1) / kBlockX;
  const double ax = c.op.x - g.x0, ay = c.op.y - g.y0;
  for (int bj = c.first_row; bj <= c.last_row; ++bj) {
    const double y = (bj + 0.5) * kBlockY * g.cell_y - ay;
    const double y_near = scalar_max(0.0, scalar_abs(y) - half_y), y_far = scalar_abs(y) + half_y;
    if (y_near > ring.outer + 1e-3) continue;
    const double w = half_chord(ring.outer, y_near) + 1e-3;
    const double x0 = scalar_max(-w, left) - half_x, x1 = scalar_min(w, right) + half_x;
    // Interior blocks have all their cells between these.
    const float far = static_cast<float>(half_chord(ring.safe_outer, y_far) - half_x - 1e-3);
    const double gap = half_chord(ring.safe_inner, y_near);
    const float near = static_cast<float>(gap > 0 ? gap + half_x + 1e-3 : 0.0);
    const auto blocks = [&](double from, double to) {
      const double b0 = (ax + from) * g.per_block_x - 0.5, b1 = (ax + to) * g.per_block_x - 0.5;
      if (b0 > b1 || b1 < 0 || b0 > last_column) return;
      const int first = b0 <= 0 ? 0 : ceil_int(b0),
                last = b1 >= last_column ? last_column : floor_int(b1);
      if (first <= last) out.add_ring(bj, first, last, near, far);
    };
    const double hole = ring.inner > 0 ? half_chord(ring.inner, y_far) - half_x - 1e-3 : 0.0;
    if (hole > 8 * g.cell_x) {
      // At least four blocks apart: no block belongs to both sides.
      blocks(x0, scalar_min(x1, -hole));
      blocks(scalar_max(x0, hole), x1);
    } else {
      blocks(x0, x1);
    }
  }
}

inline Frame frame_of(const SweepOp& op) {
  return op.kind == SweepOp::Kind::kStrip ? Frame{op.cos, op.sin, op.slope} : Frame{};
}

/// One sweep on its way: the lists, and what to do with them.
template <class EvalF, class EvalD>
struct SingleSweep {
  SweepContext& c;
  Frame frame;
  EvalF eval;
  WorkLists lists;
  explicit SingleSweep(SweepContext& context)
      : c(context), frame(frame_of(c.op)), eval(c.tool, c.op, c.extent()) {}
  static void flush(void* self) {
    SingleSweep& s = *static_cast<SingleSweep*>(self);
    if (s.lists.interior.count > 0) work_off<EvalD, true>(s.c, s.lists.interior, s.frame, s.eval);
    if (s.lists.edge.count > 0) work_off<EvalD, false>(s.c, s.lists.edge, s.frame, s.eval);
  }
};

template <class EvalD>
struct DoubleSweep {
  SweepContext& c;
  Frame frame;
  EvalD eval;
  WorkLists lists;
  explicit DoubleSweep(SweepContext& context)
      : c(context), frame(frame_of(c.op)), eval(c.tool, c.op) {}
  static void flush(void* self) {
    DoubleSweep& s = *static_cast<DoubleSweep*>(self);
    work_off_double(s.c, s.lists.edge, s.frame, s.eval);
  }
};

template <class Sweep>
void walk(SweepContext& c, double interior_mm) {
  Sweep sweep(c);
  RunWriter out(c, sweep.lists, sweep.frame, interior_mm, &Sweep::flush, &sweep);
  const SweepOp& op = c.op;
  if (op.kind == SweepOp::Kind::kStrip)
    walk_strip(c, out);
  else
    walk_ring(c, ring_of(c), out);
  out.flush();
}

template <class EvalD>
void sweep_double(SweepContext& c) {
  walk<DoubleSweep<EvalD>>(c, -1);
}

template <class EvalF, class EvalD>
void sweep_single(SweepContext& c, double interior_mm) {
  if (c.op.use_double)
    sweep_double<EvalD>(c);
  else
    walk<SingleSweep<EvalF, EvalD>>(c, interior_mm);
}

template <template <class> class Shape, Joint kJoint>
void sweep_strip(SweepContext& c) {
  sweep_single<StripEval<F8, Shape<F8>, kJoint>, StripEval<D8, Shape<D8>, kJoint>>(
      c, interior_width(c));
}

template <template <class> class Shape>
void sweep_shape(SweepContext& c) {
  switch (c.op.kind) {
    case SweepOp::Kind::kStrip:
      if (!c.op.joined) return sweep_strip<Shape, Joint::kNone>(c);
      if (c.op.straight_on) return sweep_strip<Shape, Joint::kStraight>(c);
      return sweep_strip<Shape, Joint::kTurned>(c);
    case SweepOp::Kind::kCap: {
      return sweep_single<CapEval<F8, Shape<F8>>, CapEval<D8, Shape<D8>>>(c, -1);
    }
    case SweepOp::Kind::kArc: {
      return sweep_single<ArcEval<F8, Shape<F8>>, ArcEval<D8, Shape<D8>>>(c, -1);
    }
    case SweepOp::Kind::kHelix:
      return sweep_double<HelixEval>(c);
  }
}

inline void sweep_context(SweepContext& c) {
  switch (c.tool.kind) {
    case ConvexTool::Kind::kFlat:
      return sweep_shape<FlatLanes>(c);
    case ConvexTool::Kind::kBall:
      return sweep_shape<BallLanes>(c);
    case ConvexTool::Kind::kPieces:
      return sweep_shape<PieceLanes>(c);
  }
}

inline void sweep_block_rows(GridView& grid, const ConvexTool& tool, const SweepOp& op,
                             int first_row, int last_row, SweepTotals* totals) {
  SweepContext context{grid, tool, op, first_row, last_row};
  sweep_context(context);
  SweepTotals& sum = totals[op.report];
  sum.removed += context.sum;
  sum.depth = context.depth > sum.depth ? context.depth : sum.depth;
}

inline void run_all(GridView& grid, const ConvexTool& tool, const SweepOp* ops, std::size_t count,
                    int first_band, int band_step, SweepTotals* totals) {
  const double row_height = kBlockY * grid.cell_y;
  const int last_block_row = (grid.ny - 1) / kBlockY;
  for (std::size_t n = 0; n < count; ++n) {
    const SweepOp& op = ops[n];
    const double from = (op.min_y - tool.radius - 1e-3 - grid.y0) / row_height;
    const double to = (op.max_y + tool.radius + 1e-3 - grid.y0) / row_height;
    if (to < 0 || from >= last_block_row + 1) continue;
    if (op.max_x + tool.radius < grid.x0 ||
        op.min_x - tool.radius > grid.x0 + grid.nx * grid.cell_x)
      continue;
    const int row0 = from <= 0 ? 0 : floor_int(from),
              row1 = to >= last_block_row ? last_block_row : floor_int(to);
    if (band_step == 1) {
      sweep_block_rows(grid, tool, op, row0, row1, totals);
      continue;
    }
    for (int band = row0 / kTileBlocksY; band <= row1 / kTileBlocksY; ++band) {
      if (band % band_step != first_band) continue;
      const int top = band * kTileBlocksY, bottom = top + kTileBlocksY - 1;
      sweep_block_rows(grid, tool, op, row0 > top ? row0 : top, row1 < bottom ? row1 : bottom,
                       totals);
    }
  }
}

}  // namespace kerf::KERF_LANES_NAMESPACE
