// stock/zmap/work_off.h - from listed runs of blocks to lowered cells.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including work_off.h"
#endif

#include "stock/zmap/sweep_evals.h"

namespace kerf::KERF_LANES_NAMESPACE {

/// Offsets of the cells of a block from its first one, in the frame of the sweep.
template <class T>
struct BlockOffsets {
  T p, q, track;
  BlockOffsets(const GridView& grid, const Frame& f)
      : p(x() * all(grid.cell_x * f.cos) + y() * all(grid.cell_y * f.sin)),
        q(y() * all(grid.cell_y * f.cos) - x() * all(grid.cell_x * f.sin)),
        track(all(f.slope) * p) {}

 private:
  using S = typename T::Scalar;
  static T all(double v) { return T::all(static_cast<S>(v)); }
  static T x() {
    alignas(64) static constexpr S kX[8] = {0, 1, 0, 1, 0, 1, 0, 1};
    return T::load(kX);
  }
  static T y() {
    alignas(64) static constexpr S kY[8] = {0, 0, 1, 1, 2, 2, 3, 3};
    return T::load(kY);
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

/// A block of a run.
struct Block {
  int column, bj;
  float* cells;
};

/// Heights of a block in double precision.
template <class EvalD>
inline F8 evaluate_double(const SweepContext& c, const Frame& f, const Block& b, const EvalD& eval,
                          const BlockOffsets<D8>& offsets) {
  const double x = c.center_x(b.column), y = c.center_y(b.bj);
  const double p = x * f.cos + y * f.sin, q = y * f.cos - x * f.sin;
  MaskD ignored;
  return to_float(eval.template at<false>(D8::all(p) + offsets.p, D8::all(q) + offsets.q,
                                          D8::all(c.op.z + f.slope * p) + offsets.track, ignored));
}

/// Notes which move lowered a cell, in kernels that keep it.
struct CutIdWriter {
#if defined(KERF_LANES_CUT_IDS) || defined(KERF_LANES_GAPS)
  bool keeps;
  std::uint32_t id;
  explicit CutIdWriter(const SweepContext& c)
      : keeps(c.grid.cut_ids != nullptr), id(keeps ? c.grid.cut_ids[c.op.report] : 0) {}
  void note(F8 old, F8 now, float* cells) const {
    if (!keeps) return;
    const MaskF lower = now < old;
    if (any(lower)) store_where(lower, id, cut_ids_of(cells));
  }
#else
  explicit CutIdWriter(const SweepContext&) {}
  void note(F8, F8, float*) const {}
#endif
};

/// Finds the cells that a sweep lowers into a gap, in kernels that know of gaps.
struct GapOpener {
#if defined(KERF_LANES_GAPS)
  const GridView& grid;
  std::uint32_t report;
  F8 thinnest;
  explicit GapOpener(const SweepContext& c)
      : grid(c.grid), report(c.op.report), thinnest(F8::all(c.grid.gaps.thinnest)) {}
  /// Of a block that has been lowered from `old` to `now`: what was removed of each cell.
  F8 removed(const Block& b, F8 old, F8 now) const {
    const unsigned column = static_cast<unsigned>(b.column), row = static_cast<unsigned>(b.bj);
    const unsigned tile =
        row / kTileBlocksY * static_cast<unsigned>(grid.tiles_x) + column / kTileBlocksX;
    const float* const tops = grid.gaps.tops[tile];
    if (tops == nullptr) return old - now;
    const unsigned first =
        (row % kTileBlocksY * kTileBlocksX + column % kTileBlocksX) * kBlockFloats;
    const MaskF into = (now - thinnest <= F8::load(tops + first)) & (now < old);
    if (!any(into)) [[likely]]
      return old - now;
    return open(b, bits(into), static_cast<int>(tile), static_cast<int>(first), old, now);
  }

 private:
  [[gnu::noinline]] F8 open(const Block& b, unsigned into, int tile, int first, F8 old,
                            F8 now) const {
    alignas(32) float before[kBlockFloats], gone[kBlockFloats];
    store(before, old);
    store(gone, old - now);
    grid.gaps.open(grid.gaps.owner, tile, first, into, b.cells, before, gone, report);
    return F8::load(gone);
  }
#else
  explicit GapOpener(const SweepContext&) {}
  F8 removed(const Block&, F8 old, F8 now) const { return old - now; }
#endif
};

/// Lowers a block to z (kNowhere where the sweep does not come).
struct Lowering {
  F8 floor, deepest = F8::all(0), unit = F8::all(static_cast<float>(1 / kRemovedUnit_mm));
  I8 removed = I8::zero();
  [[no_unique_address]] CutIdWriter cut_ids;
  [[no_unique_address]] GapOpener gaps;
  explicit Lowering(const SweepContext& c) : floor(F8::all(c.grid.floor)), cut_ids(c), gaps(c) {}
  void apply(const Block& b, F8 z) {
    const F8 old = F8::load(b.cells);
    const F8 now = min(max(z, floor), old);
    store(b.cells, now);
    cut_ids.note(old, now, b.cells);
    const F8 gone = gaps.removed(b, old, now);
    removed = removed + round_to_int(gone * unit);
    deepest = max(deepest, gone);
  }
  void add_to(SweepContext& c) const {
    c.sum += sum_lanes(removed);
    const float top = max_lane(deepest);
    c.depth = top > c.depth ? top : c.depth;
  }
};

/// Blocks that single precision could not settle: few, so everything they need is made on the spot.
template <class EvalD>
[[gnu::noinline]] void settle(SweepContext& c, const Frame& f, const Block* blocks, int count) {
  const EvalD eval(c.tool, c.op);
  const BlockOffsets<D8> offsets(c.grid, f);
  Lowering lowering(c);
  for (int n = 0; n < count; ++n)
    lowering.apply(blocks[n], evaluate_double(c, f, blocks[n], eval, offsets));
  lowering.add_to(c);
}

/// Collects those blocks.
template <class EvalD>
class Unsettled {
 public:
  Unsettled(SweepContext& c, const Frame& f) : c_(c), frame_(f) {}
  void add(const Block& block) {
    blocks_[count_++] = block;
    if (count_ == kMost) finish();
  }
  void finish() {
    if (count_ > 0) settle<EvalD>(c_, frame_, blocks_, count_);
    count_ = 0;
  }

 private:
  static constexpr int kMost = 64;
  SweepContext& c_;
  const Frame& frame_;
  int count_ = 0;
  Block blocks_[kMost];
};

/// Where the cells of a run are, block after block.
template <bool kSameQ>
struct RunPlace {
  F8 p, q, track;
  RunPlace(const Run& run) : p(F8::all(run.p)), q(F8::all(run.q)), track(F8::all(run.track)) {}
  void advance(F8 step_p, F8 step_q, F8 step_track) {
    p = p + step_p;
    if constexpr (!kSameQ) q = q + step_q;
    track = track + step_track;
  }
};

/// Lowers the cells of the listed blocks to what `eval` says, in single precision where that is
/// sure. kSameQ: for sweeps along X, whose blocks of one row all have the same q: what depends on
/// that alone the compiler works out once a run.
template <class EvalD, bool kInterior, bool kSameQ, class EvalF>
[[gnu::always_inline]] inline void work_off(SweepContext& c, RunList& list, const Frame& f,
                                            const EvalF& eval, const BlockOffsets<F8>& offsets,
                                            Lowering& lowering) {
  const RunStep step = run_step(c.grid, f);
  const F8 step_p = F8::all(step.p), step_q = F8::all(step.q), step_track = F8::all(step.track);
  [[maybe_unused]] Unsettled<EvalD> unsettled(c, f);
  for (int n = 0; n < list.count; ++n) {
    const Run& run = list.runs[n];
    RunPlace<kSameQ> at(run);
    Block b{run.bi, run.bj, run.cells};
    const int end = b.column + run.count;
    for (;;) {
      MaskF unsure;
      const F8 z = eval.template at<kInterior>(at.p + offsets.p, at.q + offsets.q,
                                               at.track + offsets.track, unsure);
      if (kInterior || !any(unsure)) [[likely]]
        lowering.apply(b, z);
      else
        unsettled.add(b);
      if (++b.column == end) break;
      b.cells += kBlockFloats;
      at.advance(step_p, step_q, step_track);
    }
  }
  if constexpr (!kInterior) unsettled.finish();
  list.clear();
}

/// Both lists.
template <class EvalD, class EvalF>
void work_off(SweepContext& c, RunLists& lists, const Frame& f, const EvalF& eval_in_memory) {
  const EvalF eval = eval_in_memory;  // nobody has its address: its constants stay in registers
  const BlockOffsets<F8> offsets(c.grid, f);
  Lowering lowering(c);
  if (EvalF::kRowsAlike && f.sin == 0)
    work_off<EvalD, true, EvalF::kRowsAlike>(c, lists.interior, f, eval, offsets, lowering);
  else
    work_off<EvalD, true, false>(c, lists.interior, f, eval, offsets, lowering);
  work_off<EvalD, false, false>(c, lists.edge, f, eval, offsets, lowering);
  lowering.add_to(c);
}

template <class EvalD>
void work_off_double(SweepContext& c, RunList& list, const Frame& f, const EvalD& eval) {
  const BlockOffsets<D8> offsets(c.grid, f);
  Lowering lowering(c);
  for (int n = 0; n < list.count; ++n) {
    const Run& run = list.runs[n];
    for (int k = 0; k < run.count; ++k) {
      const Block b{run.bi + k, run.bj, run.cells + kBlockFloats * k};
      lowering.apply(b, evaluate_double(c, f, b, eval, offsets));
    }
  }
  lowering.add_to(c);
  list.clear();
}

}  // namespace kerf::KERF_LANES_NAMESPACE
