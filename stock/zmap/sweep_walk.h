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

/// Rows of blocks of a strip, eight at a time: where each row's blocks begin, and how many there
/// are. Positions are taken from the block in which the strip starts, so that they stay small.
class StripRows {
 public:
  [[gnu::always_inline]] StripRows(const SweepContext& c, const RunWriter& out)
      : bounds_(c),
        cos_(static_cast<float>(c.op.cos)),
        sin_(static_cast<float>(c.op.sin)),
        icos_(inverse_or_huge(c.op.cos)),
        isin_(inverse_or_huge(-c.op.sin)),
        z_(static_cast<float>(c.op.z)),
        slope_(static_cast<float>(c.op.slope)),
        per_block_x_(static_cast<float>(c.grid.per_block_x)),
        block_x_(static_cast<float>(kBlockX * c.grid.cell_x)),
        block_y_(static_cast<float>(kBlockY * c.grid.cell_y)),
        to_center_(out.to_center()),
        step_q_(out.step_q()),
        interior_(out.interior()) {
    const GridView& g = c.grid;
    home_i_ = floor_int((c.op.x - g.x0) * g.per_block_x);
    home_j_ = floor_int((c.op.y - g.y0) * g.per_block_y);
    const double block_x = kBlockX * g.cell_x, block_y = kBlockY * g.cell_y;
    const double ax = c.op.x - g.x0 - home_i_ * block_x, ay = c.op.y - g.y0 - home_j_ * block_y;
    first_column_ = static_cast<float>(-home_i_);
    last_column_ = static_cast<float>((g.nx - 1) / kBlockX - home_i_);
    center_y_ = static_cast<float>(0.5 * block_y - ay);
    shift_ = static_cast<float>(ax * g.per_block_x - 0.5);
    cell_x_ = static_cast<float>(0.5 * g.cell_x - ax);
    cell_y_ = static_cast<float>(0.5 * g.cell_y - ay);
  }

  /// For rows first .. first + 7, one lane each: column of the first block, count (none if <= 0),
  /// and (p, q, track, 0) of the first cell.
  struct Found {
    alignas(32) float begins[kRunsAtOnce], counts[kRunsAtOnce], starts[4 * kRunsAtOnce];
    unsigned rows = 0, interior = 0;  ///< a bit a lane: there are blocks; all of them are interior
  };
  [[gnu::always_inline]] void find(int first, int lane, Found& found) const {
    alignas(32) static constexpr float kLane[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const auto all = [](float v) { return F8::all(v); };
    const F8 zero = all(0), one = all(1), cos = all(cos_), sin = all(sin_);
    const F8 row = all(static_cast<float>(first - home_j_)) + F8::load(kLane);
    const F8 y = row * all(block_y_) + all(center_y_);
    const F8 y_sin = y * sin, y_cos = y * cos;
    F8 low = all(-1e9f), high = all(1e9f);
    clip(all(icos_), y_sin, all(bounds_.lower), all(bounds_.upper), low, high);
    const F8 side = all(bounds_.radius + bounds_.half_v), half_v = all(bounds_.half_v);
    clip(all(isin_), y_cos, zero - side, side, low, high);
    const F8 v1 = y_cos - low * sin, v2 = y_cos - high * sin;
    const F8 v_min = min(v1, v2) - half_v, v_max = max(v1, v2) + half_v;
    const F8 radius = all(bounds_.radius);
    const F8 v_far = min(radius, max(zero - v_min, v_max));
    const F8 v_near = min(radius, max(zero, max(v_min, zero - v_max)));
    F8 u_low, u_high;
    bounds_.tighten(v_near, v_far, u_low, u_high);
    clip(all(icos_), y_sin, u_low, u_high, low, high);
    // Block columns, relative to home_i_: centres between low and high.
    const F8 to_block = all(per_block_x_), shift = all(shift_);
    const F8 begin = zero - floor(zero - max(low * to_block + shift, all(first_column_)));
    const F8 end =
        floor(max(min(high * to_block + shift, all(last_column_)), all(first_column_) - one));
    const F8 x0 = min(begin, all(last_column_)) * all(block_x_) + all(cell_x_);
    const F8 y0 = row * all(block_y_) + all(cell_y_);
    const F8 p0 = x0 * cos + y0 * sin;
    const F8 q0 = y0 * cos - x0 * sin, count = end - begin + one;
    const F8 q_first = q0 + all(to_center_);
    const F8 q_last = q_first + (count - one) * all(step_q_);
    found.interior |= bits(max(abs(q_first), abs(q_last)) <= all(interior_)) << lane;
    found.rows |= bits(count > zero) << lane;
    store(found.begins + lane, begin + all(static_cast<float>(home_i_)));
    store(found.counts + lane, count);
    store_rows(found.starts + 4 * lane, p0, q0, all(z_) + all(slope_) * p0);
  }

 private:
  StripBounds bounds_;
  float cos_, sin_, icos_, isin_, z_, slope_;
  float per_block_x_, block_x_, block_y_;
  float to_center_, step_q_, interior_;
  float first_column_, last_column_, center_y_, shift_, cell_x_, cell_y_;
  int home_i_, home_j_;
};

/// Gives `out` every run of blocks that the strip can touch.
[[gnu::noinline]] inline void walk_strip(const SweepContext& c, RunWriter& out) {
  const StripRows strip(c, out);
  const bool is_short = c.is_short();
  for (int first = c.first_row; first <= c.last_row; first += kRunsAtOnce) {
    const int left = c.last_row - first;
    StripRows::Found found;
    strip.find(first, 0, found);
    if (left >= 8) strip.find(first + 8, 8, found);
    unsigned rows = found.rows;
    if (left < kRunsAtOnce - 1) rows &= (2u << left) - 1;
    if (is_short) out.make_room();
    for (; rows != 0; rows &= rows - 1) {
      const int lane = __builtin_ctz(rows);
      const int b0 = static_cast<int>(found.begins[lane]), n = static_cast<int>(found.counts[lane]);
      if (is_short)
        out.add_short(first + lane, b0, n, found.starts + 4 * lane,
                      (found.interior >> lane & 1) != 0);
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
  RunLists lists;
  explicit SingleSweep(SweepContext& context)
      : c(context), frame(frame_of(c.op)), eval(c.tool, c.op, c.extent()) {}
  static void flush(void* self) {
    SingleSweep& s = *static_cast<SingleSweep*>(self);
    work_off<EvalD>(s.c, s.lists, s.frame, s.eval);
  }
};

template <class EvalD>
struct DoubleSweep {
  SweepContext& c;
  Frame frame;
  EvalD eval;
  RunLists lists;
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
  // The outer cells of a row of blocks lie half a cell within it.
  const double inset = 0.5 / kBlockY;
  for (std::size_t n = 0; n < count; ++n) {
    const SweepOp& op = ops[n];
    const double from = (op.min_y - tool.radius - 1e-3 - grid.y0) / row_height - (1 - inset);
    const double to = (op.max_y + tool.radius + 1e-3 - grid.y0) / row_height - inset;
    if (to < 0 || from > last_block_row) continue;
    if (op.max_x + tool.radius < grid.x0 ||
        op.min_x - tool.radius > grid.x0 + grid.nx * grid.cell_x)
      continue;
    const int row0 = from <= 0 ? 0 : ceil_int(from),
              row1 = to >= last_block_row ? last_block_row : floor_int(to);
    if (row0 > row1) continue;
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
