// stock/zmap/sweep_kernel.h - cuts elementary sweeps into the height grid. Included by
// sweep_scalar.cpp and sweep_avx2.cpp; the two give the same bits (lanes.h).
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
#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including sweep_kernel.h"
#endif

#include "stock/zmap/lanes.h"
#include "stock/zmap/sweep_ops.h"
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
/// Slack of block bounds: they may include too much, never too little.
constexpr float kBoundSlack_mm = 1e-3f;
/// A strip that extends no farther than this from its start has block positions computed in single
/// precision.
constexpr double kShortReach_mm = 10.0;

inline double scalar_min(double a, double b) { return a < b ? a : b; }
inline double scalar_max(double a, double b) { return a > b ? a : b; }
inline double scalar_abs(double a) { return a < 0 ? -a : a; }
inline int ceil_int(double x) {
  const int i = static_cast<int>(x);
  return i < x ? i + 1 : i;
}
inline int floor_int(double x) {
  const int i = static_cast<int>(x);
  return i > x ? i - 1 : i;
}

/// Blocks to be worked off. p, q: position of the block's first cell in the frame of the sweep
/// (strip: u, v; else x, y from its centre); track: height of a strip's track there.
struct alignas(32) Block {
  float p, q, track, unused;
  std::int64_t where;  ///< row * 2^32 + column of the block
  float* cells;
  int bi() const { return static_cast<int>(where & 0x7fffffff); }
  int bj() const { return static_cast<int>(where >> 32); }
};
constexpr int kListBlocks = 256;

/// Takes one more run than kListBlocks: it is emptied before a run is added when it is above.
struct WorkList {
  int count = 0;
  Block blocks[kListBlocks + kTileBlocks + 1];
};

/// Blocks that lie well within the width of a strip, and those that may reach its edge.
struct WorkLists {
  WorkList interior, edge;
};

/// What one sweep needs on one band; knows how to walk rows and where cells are.
struct SweepContext {
  GridView& grid;
  const ConvexTool& tool;
  const SweepOp& op;
  int first_row, last_row;  ///< block rows of the band
  std::int64_t sum =
      0;  ///< heights removed, in kRemovedUnit_mm: integers, so that no order of adding matters
  float depth = 0;

  double center_x(int bi) const { return (bi * 4 + 0.5) * grid.cell_x - (op.x - grid.x0); }
  double center_y(int bj) const { return (bj * 4 + 0.5) * grid.cell_y - (op.y - grid.y0); }
  float* tile(int index) {
    float* cells = grid.tiles[index];
    return cells ? cells : grid.make_writable(grid.owner, index);
  }
};

/// Offsets of the 8 + 8 cells of a block from its first one, in the frame of the sweep.
template <class T>
struct BlockOffsets {
  T p[2], q[2], track[2];
  BlockOffsets(const GridView& grid, double cos, double sin, double slope) {
    using S = typename T::Scalar;
    alignas(64) static constexpr S kX[8] = {0, 1, 2, 3, 0, 1, 2, 3};
    alignas(64) static constexpr S kY[2][8] = {{0, 0, 0, 0, 1, 1, 1, 1}, {2, 2, 2, 2, 3, 3, 3, 3}};
    const auto all = [](double x) { return T::all(static_cast<S>(x)); };
    const T x = T::load(kX);
    for (int half = 0; half < 2; ++half) {
      const T y = T::load(kY[half]);
      p[half] = x * all(grid.cell_x * cos) + y * all(grid.cell_y * sin);
      q[half] = y * all(grid.cell_y * cos) - x * all(grid.cell_x * sin);
      track[half] = all(slope) * p[half];
    }
  }
};

inline std::int64_t sum_lanes(I8 a) {
  alignas(32) std::int32_t lanes[8];
  store(lanes, a);
  std::int64_t sum = 0;
  for (const std::int32_t lane : lanes) sum += lane;
  return sum;
}
inline float max_lane(F8 a) {
  alignas(32) float lanes[8];
  store(lanes, a);
  float top = 0;
  for (float lane : lanes) top = lane > top ? lane : top;
  return top;
}

/// Frame of a sweep: turns grid axes into (p, q); track = z + slope * p.
struct Frame {
  double cos = 1, sin = 0, slope = 0;
};

/// Heights of half a block in double precision.
template <class EvalD>
inline F8 evaluate_double(const SweepContext& c, const Frame& f, const Block& b, int half,
                          const EvalD& eval, const BlockOffsets<D8>& offsets) {
  const double x = c.center_x(b.bi()), y = c.center_y(b.bj());
  const double p = x * f.cos + y * f.sin, q = y * f.cos - x * f.sin;
  MaskD ignored;
  return to_float(
      eval.template at<false>(D8::all(p) + offsets.p[half], D8::all(q) + offsets.q[half],
                              D8::all(c.op.z + f.slope * p) + offsets.track[half], ignored));
}

/// Lowers half a block to z (infinity where the sweep does not come).
struct Lowering {
  F8 floor, deepest = F8::all(0), unit = F8::all(static_cast<float>(1 / kRemovedUnit_mm));
  I8 removed = I8::zero();
  explicit Lowering(const GridView& grid) : floor(F8::all(grid.floor)) {}
  void apply(float* cells, F8 z) {
    const F8 old = F8::load(cells);
    const F8 now = min(max(z, floor), old);
    store(cells, now);
    const F8 gone = old - now;
    removed = removed + round_to_int(gone * unit);
    deepest = max(deepest, gone);
  }
  void add_to(SweepContext& c) const {
    c.sum += sum_lanes(removed);
    const float top = max_lane(deepest);
    c.depth = top > c.depth ? top : c.depth;
  }
};

/// Half blocks that single precision could not settle: few, so everything they need is made on the
/// spot.
template <class EvalD>
[[gnu::noinline]] void settle(SweepContext& c, const WorkList& list, const Frame& f,
                              const std::int16_t* halves, int count) {
  const EvalD eval(c.tool, c.op);
  const BlockOffsets<D8> offsets(c.grid, f.cos, f.sin, f.slope);
  Lowering lowering(c.grid);
  for (int n = 0; n < count; ++n) {
    const Block& b = list.blocks[halves[n] / 2];
    const int half = halves[n] % 2;
    lowering.apply(b.cells + 8 * half, evaluate_double(c, f, b, half, eval, offsets));
  }
  lowering.add_to(c);
}

/// Lowers the cells of the listed blocks to what `eval` says, in single precision where that is
/// sure.
template <class EvalD, bool kInterior, class EvalF>
void work_off(SweepContext& c, WorkList& list, const Frame& f, const EvalF& eval_in_memory) {
  const EvalF eval =
      eval_in_memory;  // a local whose address nobody has: its constants stay in registers
  const BlockOffsets<F8> offsets(c.grid, f.cos, f.sin, f.slope);
  Lowering lowering(c.grid);
  std::int16_t unsettled[2 * (kListBlocks + kTileBlocks + 1)];
  int unsettled_count = 0;
  for (int n = 0; n < list.count; ++n) {
    const Block& b = list.blocks[n];
    const F8 p = F8::all(b.p), q = F8::all(b.q), track = F8::all(b.track);
    for (int half = 0; half < 2; ++half) {
      MaskF unsure;
      const F8 z = eval.template at<kInterior>(p + offsets.p[half], q + offsets.q[half],
                                               track + offsets.track[half], unsure);
      if constexpr (!kInterior) {
        if (any(unsure)) [[unlikely]] {
          unsettled[unsettled_count++] = static_cast<std::int16_t>(2 * n + half);
          continue;
        }
      }
      lowering.apply(b.cells + 8 * half, z);
    }
  }
  lowering.add_to(c);
  if (unsettled_count > 0) settle<EvalD>(c, list, f, unsettled, unsettled_count);
  list.count = 0;
}

template <class EvalD>
void work_off_double(SweepContext& c, WorkList& list, const Frame& f, const EvalD& eval) {
  const BlockOffsets<D8> offsets(c.grid, f.cos, f.sin, f.slope);
  Lowering lowering(c.grid);
  for (int n = 0; n < list.count; ++n) {
    for (int half = 0; half < 2; ++half) {
      lowering.apply(list.blocks[n].cells + 8 * half,
                     evaluate_double(c, f, list.blocks[n], half, eval, offsets));
    }
  }
  lowering.add_to(c);
  list.count = 0;
}

/// Where a run of blocks in one row begins: position of its first cell in the frame of the sweep.
struct RunStart {
  float p, q, track;
};

inline RunStart run_start(const SweepContext& c, const Frame& f, int bi, int bj) {
  const double x = c.center_x(bi), y = c.center_y(bj);
  const double p = x * f.cos + y * f.sin, q = y * f.cos - x * f.sin;
  return {static_cast<float>(p), static_cast<float>(q), static_cast<float>(c.op.z + f.slope * p)};
}

/// Puts runs of blocks on the lists and works them off when full.
template <class Flush>
class RunWriter {
 public:
  /// Blocks whose centre lies within `interior_mm` of the track are interior (none if negative).
  RunWriter(SweepContext& c, WorkLists& lists, const Frame& f, double interior_mm,
            const Flush& flush)
      : c_(c),
        lists_(lists),
        frame_(f),
        flush_(flush),
        interior_(static_cast<float>(interior_mm)),
        to_center_(static_cast<float>(1.5 * (c.grid.cell_y * f.cos - c.grid.cell_x * f.sin))),
        dp_(static_cast<float>(4 * c.grid.cell_x * f.cos)),
        dq_(static_cast<float>(-4 * c.grid.cell_x * f.sin)),
        dt_(static_cast<float>(f.slope * 4 * c.grid.cell_x * f.cos)),
        step_(F4::of(dp_, dq_, dt_, 0)) {}

  /// Blocks b0..b1 of row bj; positions computed afresh in double precision in each tile.
  [[gnu::noinline]] void add(int bj, int b0, int b1) {
    for (int bi = b0; bi <= b1;) {
      const int tile_end = bi | (kTileBlocks - 1), last = tile_end < b1 ? tile_end : b1;
      put(bj, bi, last, run_start(c_, frame_, bi, bj));
      bi = last + 1;
    }
  }
  /// The same for a short run whose start is known.
  [[gnu::always_inline]] void add(int bj, int b0, int b1, RunStart start) {
    if (b1 <= (b0 | (kTileBlocks - 1))) [[likely]]
      put(bj, b0, b1, start);
    else
      add_across_tiles(bj, b0, b1, start);
  }

 private:
  [[gnu::always_inline]] void put(int bj, int b0, int b1, RunStart at) {
    const int count = b1 - b0 + 1;
    if (lists_.interior.count > kListBlocks || lists_.edge.count > kListBlocks) flush_();
    const unsigned column = static_cast<unsigned>(b0), row = static_cast<unsigned>(bj);
    const unsigned tile =
        row / kTileBlocks * static_cast<unsigned>(c_.grid.tiles_x) + column / kTileBlocks;
    float* cells = c_.tile(static_cast<int>(tile)) +
                   (row % kTileBlocks * kTileBlocks + column % kTileBlocks) * 16;
    const std::int64_t where = (static_cast<std::int64_t>(bj) << 32) + b0;
    F4 place = F4::of(at.p, at.q, at.track, 0);
    if (count <= kBlindBlocks) {
      // Written whether needed or not: cheaper than guessing wrongly how many there are.
      const float q_first = at.q + to_center_,
                  q_last = q_first + static_cast<float>(count - 1) * dq_;
      WorkList& list = is_interior(q_first) & is_interior(q_last) ? lists_.interior : lists_.edge;
      Block* out = list.blocks + list.count;
      for (int k = 0; k < kBlindBlocks; ++k, place = place + step_)
        write(out[k], place, where + k, cells + 16 * k);
      list.count += count;
      return;
    }
    float q = at.q + to_center_;
    for (int k = 0; k < count; ++k, place = place + step_, q += dq_) {
      WorkList& list = is_interior(q) ? lists_.interior : lists_.edge;
      write(list.blocks[list.count++], place, where + k, cells + 16 * k);
    }
  }
  static void write(Block& block, F4 place, std::int64_t where, float* cells) {
    store(&block.p, place);
    block.where = where;
    block.cells = cells;
  }
  [[gnu::noinline]] void add_across_tiles(int bj, int b0, int b1, RunStart at) {
    while (b0 <= b1) {
      const int tile_end = b0 | (kTileBlocks - 1), last = tile_end < b1 ? tile_end : b1;
      put(bj, b0, last, at);
      const float n = static_cast<float>(last + 1 - b0);
      at = {at.p + n * dp_, at.q + n * dq_, at.track + n * dt_};
      b0 = last + 1;
    }
  }
  bool is_interior(float q_center) const { return __builtin_fabsf(q_center) <= interior_; }

  static constexpr int kBlindBlocks = 3;
  SweepContext& c_;
  WorkLists& lists_;
  const Frame& frame_;
  const Flush& flush_;
  float interior_, to_center_;
  float dp_, dq_, dt_;
  F4 step_;
};

/// Squared-radius band beside the wall in which single precision is not trusted; `reach` bounds the
/// coordinates involved.
inline double unsure_band(const ConvexTool& tool, double steepness, double reach) {
  // Rounding of a distance up to `reach`, plus that of block positions up to kShortReach_mm or a
  // tile away from where they were computed in double precision.
  const double rounding = 2e-7 * reach + 1.5e-6;
  const double w =
      scalar_min(tool.radius, steepness * tool.radius * rounding / kSinglePrecision_mm);
  return w * w + 4 * tool.radius * rounding;
}

/// What follows a strip: nothing, a strip in the same direction, or one that turns.
enum class Joint { kNone, kStraight, kTurned };

/// Distance from the track within which a strip's cells are so far from the tool's wall that no
/// test against it is needed; negative if there is none. Balls only: their contact point keeps away
/// from the equator by w / sqrt(1 + s^2) with w = sqrt(R^2 - v^2), and so does a wedge between two
/// strips in nearly the same direction.
inline double interior_width(const SweepContext& c) {
  const SweepOp& op = c.op;
  if (c.tool.kind != ConvexTool::Kind::kBall) return -1;
  double steepest = op.slope_m, turn = 0;
  if (op.joined) {
    steepest = scalar_max(steepest, op.next_m);
    turn = op.straight_on ? 0.0 : scalar_abs(op.cos * op.next_sin - op.sin * op.next_cos);
  }
  const double r2 = c.tool.radius * c.tool.radius;
  const double band = unsure_band(c.tool, op.slope_m, c.tool.radius);
  const double needed = steepest * steepest * (band + 2 * r2 * turn * (1 + turn)) + 1e-3 * r2;
  const double half_block =
      1.5 * (c.grid.cell_x * scalar_abs(op.sin) + c.grid.cell_y * scalar_abs(op.cos)) + 1e-3;
  return needed < r2 ? scalar_sqrt(r2 - needed) - half_block : -1;
}

template <class T, class Shape, Joint kJoint>
struct StripEval {
  using S = typename T::Scalar;
  using Mask = typename T::Mask;
  static constexpr bool kDouble = sizeof(S) == sizeof(double);
  Shape shape, next;
  bool edges;
  T radius2, tie, overlap, length, length_over, band, turn_cos, turn_sin, vertex_z, edge_band;

  static T all(double x) { return T::all(static_cast<S>(x)); }
  StripEval(const ConvexTool& tool, const SweepOp& op)
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
        band(all(unsure_band(tool, op.slope_m, tool.radius))),
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
    const T d2 = a * a + v2;
    Mask between = (t >= length + overlap) & (u_next - rho <= all(0) - overlap);
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
  using S = typename T::Scalar;
  using Mask = typename T::Mask;
  static constexpr bool kDouble = sizeof(S) == sizeof(double);
  Shape shape;
  T radius2, tie, tip_z, band;
  static T all(double x) { return T::all(static_cast<S>(x)); }
  CapEval(const ConvexTool& tool, const SweepOp& op)
      : shape(tool, {}),
        radius2(all(tool.radius * tool.radius)),
        tie(all(kDouble ? -2 * tool.radius * kEdgeTie_mm : 0.0)),
        tip_z(all(op.z)),
        band(all(unsure_band(tool, 1.0, tool.radius))) {}
  template <bool kInterior>
  T at(T x, T y, T, Mask& unsure) const {
    const T d2 = x * x + y * y;
    const T w2 = radius2 - d2;
    unsure = all(0) > all(0);
    if constexpr (!kDouble) unsure = abs(w2) <= band;
    return select(w2 >= tie, tip_z + shape.surface(d2), all(kNowhere));
  }
};

template <class T, class Shape>
struct ArcEval {
  using S = typename T::Scalar;
  using Mask = typename T::Mask;
  static constexpr bool kDouble = sizeof(S) == sizeof(double);
  Shape shape;
  bool full, over_half;
  T radius2, tie, tip_z, band, path, cos0, sin0, cos1, sin1, overlap;
  static T all(double x) { return T::all(static_cast<S>(x)); }
  ArcEval(const ConvexTool& tool, const SweepOp& op)
      : shape(tool, {}),
        full(op.full_circle),
        over_half(op.over_half),
        radius2(all(tool.radius * tool.radius)),
        tie(all(kDouble ? -2 * tool.radius * kEdgeTie_mm : 0.0)),
        tip_z(all(op.z)),
        band(all(unsure_band(tool, 1.0, tool.radius + op.radius))),
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
    unsure = all(0) > all(0);
    if constexpr (!kDouble) unsure = near;
    return select(inside, tip_z + shape.surface(d2), all(kNowhere));
  }
};

/// Angle of (x, y), -pi..pi, from correctly rounded operations only (libm differs between hosts).
/// Error below 1e-13.
inline D8 angle_of(D8 y, D8 x) {
  const D8 ax = abs(x), ay = abs(y), one = D8::all(1);
  D8 r = min(ax, ay) / max(max(ax, ay), D8::all(1e-300));
  for (int halving = 0; halving < 2; ++halving) r = r / (one + sqrt(one + r * r));
  const D8 r2 = r * r;
  D8 series = D8::all(1.0 / 21);
  for (int n = 19; n >= 1; n -= 2) series = D8::all(1.0 / n) - r2 * series;
  D8 angle = D8::all(4) * r * series;
  angle = select(ay > ax, D8::all(1.57079632679489661923) - angle, angle);
  angle = select(x < D8::all(0), D8::all(3.14159265358979323846) - angle, angle);
  return select(y < D8::all(0), D8::all(0) - angle, angle);
}

/// Helix that descends along its angle phi = 0..length: height z - slope*phi + f(distance). Over
/// one cell the distance is periodic in phi; on each turn the height has one minimum behind the
/// axis (psi in 0..pi), found by bisection over the distance d; the last turn that holds it is the
/// lowest. Ends are caps.
struct HelixEval {
  const ConvexTool& tool;
  const SweepOp& op;
  HelixEval(const ConvexTool& t, const SweepOp& o) : tool(t), op(o) {}
  static D8 all(double x) { return D8::all(x); }

  /// f'(d) * a >= b * 1, kept finite where f' is infinite.
  MaskD descends(D8 d, D8 a, D8 b) const {
    D8 rise = all(0), run = all(1);
    if (tool.kind == ConvexTool::Kind::kBall) {
      rise = d;
      run = sqrt(max(all(tool.radius * tool.radius) - d * d, all(0)));
    } else if (tool.kind == ConvexTool::Kind::kPieces) {
      for (int i = 0; i < tool.piece_count; ++i) {
        const ToolPiece& p = tool.pieces[i];
        const MaskD here = d >= all(p.r0);
        const D8 y = d - all(p.center_r);
        rise = select(here, p.arc ? y : all(p.slope), rise);
        run =
            select(here, p.arc ? sqrt(max(all(p.radius * p.radius) - y * y, all(0))) : all(1), run);
      }
    }
    return rise * a < b * run;
  }
  D8 surface(D8 d2) const {
    switch (tool.kind) {
      case ConvexTool::Kind::kFlat:
        return FlatLanes<D8>(tool, {}).surface(d2);
      case ConvexTool::Kind::kBall:
        return BallLanes<D8>(tool, {}).surface(d2);
      case ConvexTool::Kind::kPieces:
        return PieceLanes<D8>(tool, {}).surface(d2);
    }
    return all(0);
  }

  template <bool kInterior>
  D8 at(D8 x, D8 y, D8, MaskD& unsure) const {
    unsure = all(0) > all(0);
    const D8 rr = sqrt(x * x + y * y);
    const D8 path = all(op.radius);
    const D8 closest = abs(rr - path), farthest = rr + path;
    const D8 product = max(rr * path, all(1e-30));
    const D8 squares = rr * rr + path * path;
    const D8 limit = min(farthest, all(tool.radius + kEdgeTie_mm));
    const D8 fall = all(op.slope);
    // sin(psi)/d grows up to d_peak and shrinks from there.
    const D8 wide = max(rr, path), narrow = min(rr, path);
    const D8 peak = min(max(sqrt(max(wide * wide - narrow * narrow, all(0))), closest), limit);
    const MaskD still_falling = falls(peak, squares, product, fall);
    D8 low = select(still_falling, peak, closest);
    D8 high = select(still_falling, limit, peak);
    for (int step = 0; step < 50; ++step) {
      const D8 d = all(0.5) * (low + high);
      const MaskD falling = falls(d, squares, product, fall);
      low = select(falling, d, low);
      high = select(falling, high, d);
    }
    const D8 d = all(0.5) * (low + high);
    // Ended at the far side of the path without a minimum: the height falls through the whole turn.
    const MaskD none = (d >= farthest - all(1e-9)) & (limit >= farthest);
    const D8 cosine = (squares - d * d) / (all(2) * product);
    const D8 psi = angle_of(sqrt(max(all(1) - cosine * cosine, all(0))), cosine);
    D8 theta = angle_of(all(op.over_half ? -1 : 1) * (all(op.cos) * y - all(op.sin) * x),
                        all(op.cos) * x + all(op.sin) * y);
    theta = select(theta < all(0), theta + all(kTurn), theta);
    const D8 first = theta + psi;
    const D8 turns = floor((all(op.length) - first) / all(kTurn));
    const D8 phi = first + turns * all(kTurn);
    const MaskD inside = (closest <= all(tool.radius + kEdgeTie_mm)) & (phi >= all(0));
    const D8 z = all(op.z) - fall * phi + surface(min(d * d, all(tool.radius * tool.radius)));
    return select(and_not(inside, none), z, all(kNowhere));
  }

 private:
  static constexpr double kTurn = 6.28318530717958647693;
  MaskD falls(D8 d, D8 squares, D8 product, D8 fall) const {
    const D8 cosine = (squares - d * d) / (all(2) * product);
    const D8 sine = sqrt(max(all(1) - cosine * cosine, all(0)));
    return descends(d, product * sine, fall * d);
  }
};

}  // namespace kerf::KERF_LANES_NAMESPACE
