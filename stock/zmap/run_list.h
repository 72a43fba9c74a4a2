// stock/zmap/run_list.h - the blocks of cells that a sweep can touch, listed before any cell is
// looked at.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including run_list.h"
#endif

#include "stock/zmap/lanes.h"
#include "stock/zmap/sweep_ops.h"

namespace kerf::KERF_LANES_NAMESPACE {

/// Slack of block bounds: they may include too much, never too little.
constexpr float kBoundSlack_mm = 1e-3f;
/// A strip that extends no farther than this from its start has block positions computed in single
/// precision.
constexpr double kShortReach_mm = 30.0;

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

/// Blocks of one row of one tile, side by side. p, q: position of the first cell of the first block
/// in the frame of the sweep (strip: u, v; else x, y from its centre); track: height of a strip's
/// track there. Those of the next block are one RunStep further, by one addition each.
struct alignas(32) Run {
  float p, q, track;
  std::int32_t count;
  std::int32_t bi, bj;  ///< column of the first block; row
  float* cells;         ///< of the first block
};
/// Per block along a row of blocks.
struct RunStep {
  float p, q, track;
};
/// From the first cell of a block to its centre, in cells.
constexpr double kHalfX = 0.5 * (kBlockX - 1);
constexpr double kHalfY = 0.5 * (kBlockY - 1);

/// Room is looked for before at most kRunsAtOnce runs of kShortRun blocks, or a run of a tile.
constexpr int kRunsAtOnce = 16;
constexpr int kShortRun = 12;
struct RunList {
  static constexpr int kFull = 128, kCapacity = kFull + kTileBlocksX;
  /// With what comes between two looks for room still within what 32-bit lanes add up
  /// (kRemovedUnit_mm).
  static constexpr int kMostBlocks = 320;
  static_assert(kMostBlocks + kRunsAtOnce * kShortRun <= 512);
  int count = 0, blocks = 0;
  Run runs[kCapacity];
  bool is_full() const { return count > kFull || blocks > kMostBlocks; }
  void clear() { count = blocks = 0; }
};

/// Blocks that lie well within the width of a strip, and those that may reach its edge.
struct RunLists {
  RunList interior, edge;
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

  /// Positions of a short strip's blocks are computed from where it starts.
  bool is_short() const {
    return op.kind == SweepOp::Kind::kStrip && op.length + 2 * tool.radius <= kShortReach_mm;
  }
  /// How far from a position computed in double precision a block may lie, mm.
  double extent() const {
    return is_short() ? op.length + 2 * tool.radius
                      : kTileCells * scalar_max(grid.cell_x, grid.cell_y);
  }
  double center_x(int bi) const { return (bi * kBlockX + 0.5) * grid.cell_x - (op.x - grid.x0); }
  double center_y(int bj) const { return (bj * kBlockY + 0.5) * grid.cell_y - (op.y - grid.y0); }
  float* tile(int index) {
    float* cells = grid.tiles[index];
    return cells ? cells : grid.make_writable(grid.owner, index);
  }
};

/// Frame of a sweep: turns grid axes into (p, q); track = z + slope * p.
struct Frame {
  double cos = 1, sin = 0, slope = 0;
};

/// Where a run of blocks in one row begins: position of its first cell in the frame of the sweep.
struct RunStart {
  float p, q, track;
};

inline RunStep run_step(const GridView& grid, const Frame& f) {
  return {static_cast<float>(kBlockX * grid.cell_x * f.cos),
          static_cast<float>(-kBlockX * grid.cell_x * f.sin),
          static_cast<float>(f.slope * kBlockX * grid.cell_x * f.cos)};
}

inline RunStart run_start(const SweepContext& c, const Frame& f, int bi, int bj) {
  const double x = c.center_x(bi), y = c.center_y(bj);
  const double p = x * f.cos + y * f.sin, q = y * f.cos - x * f.sin;
  return {static_cast<float>(p), static_cast<float>(q), static_cast<float>(c.op.z + f.slope * p)};
}

/// Puts runs of blocks on the lists and has them worked off when full. One class for all kinds of
/// sweep: what empties the lists is called seldom, through a pointer.
class RunWriter {
 public:
  using Flush = void (*)(void* with);

  /// Blocks whose centre lies within `interior_mm` of the track are interior (none if negative).
  RunWriter(SweepContext& c, RunLists& lists, const Frame& f, double interior_mm, Flush empty_lists,
            void* sweep)
      : c_(c),
        lists_(lists),
        frame_(f),
        flush_(empty_lists),
        sweep_(sweep),
        interior_(static_cast<float>(interior_mm)),
        to_center_(
            static_cast<float>(kHalfY * c.grid.cell_y * f.cos - kHalfX * c.grid.cell_x * f.sin)),
        step_(run_step(c.grid, f)) {}

  /// Blocks b0..b1 of row bj; positions computed afresh in double precision in each tile.
  [[gnu::noinline]] void add(int bj, int b0, int b1) {
    for (int bi = b0; bi <= b1;) {
      const int tile_end = bi | (kTileBlocksX - 1), last = tile_end < b1 ? tile_end : b1;
      put(bj, bi, last - bi + 1, run_start(c_, frame_, bi, bj));
      bi = last + 1;
    }
  }
  /// The same for a ring about the sweep's centre: interior are blocks whose centre has near <= |x|
  /// <= far.
  [[gnu::noinline]] void add_ring(int bj, int b0, int b1, float near, float far) {
    const float to_middle = static_cast<float>(kHalfX * c_.grid.cell_x);
    for (int bi = b0; bi <= b1;) {
      const int tile_end = bi | (kTileBlocksX - 1), last = tile_end < b1 ? tile_end : b1;
      const RunStart at = run_start(c_, frame_, bi, bj);
      put_sorted(bj, bi, last - bi + 1, at, at.p + to_middle, step_.p, [&](float x) {
        const float a = __builtin_fabsf(x);
        return (a >= near) & (a <= far);
      });
      bi = last + 1;
    }
  }
  /// Room for kRunsAtOnce short runs.
  void make_room() {
    if (lists_.interior.is_full() || lists_.edge.is_full()) [[unlikely]]
      flush();
  }
  /// A run whose start is known (p, q, track, 0); interior as the caller found. Room must have been
  /// made.
  [[gnu::always_inline]] void add_short(int bj, int b0, int count, const float* start,
                                        bool interior) {
    const int in_tile = static_cast<int>(static_cast<unsigned>(b0) % kTileBlocksX);
    if (in_tile + count <= kTileBlocksX && count <= kShortRun) [[likely]]
      write(interior ? lists_.interior : lists_.edge, F4::load(start), b0, bj, count,
            first_cell(bj, b0));
    else
      add_across_tiles(bj, b0, count, {start[0], start[1], start[2]});
  }
  void flush() {
    if (lists_.interior.count + lists_.edge.count > 0) flush_(sweep_);
  }
  /// From the first cell of a block to its centre, and from one block of a row to the next, across
  /// the track.
  float to_center() const { return to_center_; }
  float step_q() const { return step_.q; }
  float interior() const { return interior_; }

 private:
  float* first_cell(int bj, int bi) {
    const unsigned column = static_cast<unsigned>(bi), row = static_cast<unsigned>(bj);
    const unsigned tile =
        row / kTileBlocksY * static_cast<unsigned>(c_.grid.tiles_x) + column / kTileBlocksX;
    return c_.tile(static_cast<int>(tile)) +
           (row % kTileBlocksY * kTileBlocksX + column % kTileBlocksX) * kBlockFloats;
  }
  static void write(RunList& list, F4 start, int bi, int bj, int count, float* cells) {
    Run& run = list.runs[list.count++];
    list.blocks += count;
    store(&run.p, start);
    run.count = count;
    run.bi = bi;
    run.bj = bj;
    run.cells = cells;
  }

  /// Blocks of one tile.
  void put(int bj, int b0, int count, RunStart at) {
    put_sorted(bj, b0, count, at, at.q + to_center_, step_.q,
               [this](float q) { return __builtin_fabsf(q) <= interior_; });
  }
  /// Blocks of one tile; is_interior(x) of a block says which list is its own, with x one
  /// `step` further with each block.
  template <class IsInterior>
  void put_sorted(int bj, int b0, int count, RunStart at, float x, float step,
                  const IsInterior& is_interior) {
    make_room();
    float* const cells = first_cell(bj, b0);
    const F4 next = F4::of(step_.p, step_.q, step_.track, 0);
    F4 place = F4::of(at.p, at.q, at.track, 0), start = place;
    int first = 0;
    bool interior = is_interior(x);
    for (int k = 1; k <= count; ++k) {
      place = place + next;
      x += step;
      const bool same = k < count && is_interior(x) == interior;
      if (same) continue;
      write(interior ? lists_.interior : lists_.edge, start, b0 + first, bj, k - first,
            cells + kBlockFloats * first);
      start = place;
      first = k;
      interior = !interior;
    }
  }
  [[gnu::noinline]] void add_across_tiles(int bj, int b0, int count, RunStart at) {
    const int end = b0 + count;
    while (b0 < end) {
      const int tile_end = (b0 | (kTileBlocksX - 1)) + 1, stop = tile_end < end ? tile_end : end;
      put(bj, b0, stop - b0, at);
      const float n = static_cast<float>(stop - b0);
      at = {at.p + n * step_.p, at.q + n * step_.q, at.track + n * step_.track};
      b0 = stop;
    }
  }

  SweepContext& c_;
  RunLists& lists_;
  const Frame& frame_;
  Flush flush_;
  void* sweep_;
  float interior_, to_center_;
  RunStep step_;
};

}  // namespace kerf::KERF_LANES_NAMESPACE
