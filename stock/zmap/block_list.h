// stock/zmap/block_list.h - the blocks of cells that a sweep can touch, listed before any cell is
// looked at.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including block_list.h"
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

/// Blocks to be worked off. p, q: position of the block's first cell in the frame of the sweep
/// (strip: u, v; else x, y from its centre); track: height of a strip's track there.
struct alignas(32) Block {
  float p, q, track;
  float steps;          ///< blocks from the first of its run
  std::int32_t bi, bj;  ///< column of the first block of its run; row
  float* cells;
  int column() const { return bi + static_cast<int>(steps); }
};
constexpr int kListBlocks = 384;
/// From the first cell of a block to its centre, in cells.
constexpr double kHalfX = 0.5 * (kBlockX - 1);
constexpr double kHalfY = 0.5 * (kBlockY - 1);

/// Holds more than kListBlocks, so that room need not be looked for with every run: at most eight
/// short runs or one run of a tile come between two looks.
struct WorkList {
  static constexpr int kCapacity = kListBlocks + 48;
  int count = 0;
  Block blocks[kCapacity];
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
  RunWriter(SweepContext& c, WorkLists& lists, const Frame& f, double interior_mm,
            Flush empty_lists, void* sweep)
      : c_(c),
        lists_(lists),
        frame_(f),
        flush_(empty_lists),
        sweep_(sweep),
        interior_(static_cast<float>(interior_mm)),
        to_center_(
            static_cast<float>(kHalfY * c.grid.cell_y * f.cos - kHalfX * c.grid.cell_x * f.sin)),
        dp_(static_cast<float>(kBlockX * c.grid.cell_x * f.cos)),
        dq_(static_cast<float>(-kBlockX * c.grid.cell_x * f.sin)),
        dt_(static_cast<float>(f.slope * kBlockX * c.grid.cell_x * f.cos)),
        step_(F4::of(dp_, dq_, dt_, 1)) {}

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
      make_room();
      float* cells = first_cell(bj, bi);
      const RunStart at = run_start(c_, frame_, bi, bj);
      F4 place = F4::of(at.p, at.q, at.track, 0);
      float x = at.p + to_middle;
      for (int k = 0; k <= last - bi; ++k, place = place + step_, x += dp_) {
        const float a = __builtin_fabsf(x);
        WorkList& list = ((a >= near) & (a <= far)) ? lists_.interior : lists_.edge;
        write(list.blocks[list.count++], place, bi, bj, cells + kBlockFloats * k);
      }
      bi = last + 1;
    }
  }
  /// Room for eight short runs.
  void make_room() {
    if (lists_.interior.count > kListBlocks || lists_.edge.count > kListBlocks) [[unlikely]]
      flush();
  }
  /// A run whose start is known; interior as the caller found. Room must have been made.
  [[gnu::always_inline]] void add_short(int bj, int b0, int count, const float* start,
                                        bool interior) {
    if (b0 % kTileBlocksX + count <= kTileBlocksX && count <= kBlindBlocks) [[likely]]
      put_few(bj, b0, count, start, interior);
    else
      add_across_tiles(bj, b0, count, {start[0], start[1], start[2]});
  }
  void flush() {
    if (lists_.interior.count + lists_.edge.count > 0) flush_(sweep_);
  }
  /// From the first cell of a block to its centre, and from one block of a row to the next, across
  /// the track.
  float to_center() const { return to_center_; }
  float step_q() const { return dq_; }
  float interior() const { return interior_; }

 private:
  float* first_cell(int bj, int bi) {
    const unsigned column = static_cast<unsigned>(bi), row = static_cast<unsigned>(bj);
    const unsigned tile =
        row / kTileBlocksY * static_cast<unsigned>(c_.grid.tiles_x) + column / kTileBlocksX;
    return c_.tile(static_cast<int>(tile)) +
           (row % kTileBlocksY * kTileBlocksX + column % kTileBlocksX) * kBlockFloats;
  }
  bool is_interior(float q_center) const { return __builtin_fabsf(q_center) <= interior_; }
  static void write(Block& block, F4 place, int bi, int bj, float* cells) {
    store(&block.p, place);
    block.bi = bi;
    block.bj = bj;
    block.cells = cells;
  }

  /// Up to kBlindBlocks, written whether needed or not: cheaper than guessing wrongly how many
  /// there are.
  [[gnu::always_inline]] void put_few(int bj, int b0, int count, const float* start,
                                      bool interior) {
    WorkList& list = interior ? lists_.interior : lists_.edge;
    Block* out = list.blocks + list.count;
    list.count += count;
    float* cells = first_cell(bj, b0);
    const F4 first = F4::load(start), second = first + step_;
    write(out[0], first, b0, bj, cells);
    write(out[1], second, b0, bj, cells + kBlockFloats);
    const F4 third = second + step_;
    write(out[2], third, b0, bj, cells + 2 * kBlockFloats);
    write(out[3], third + step_, b0, bj, cells + 3 * kBlockFloats);
  }
  /// Blocks of one tile.
  void put(int bj, int b0, int count, RunStart at) {
    make_room();
    float* cells = first_cell(bj, b0);
    F4 place = F4::of(at.p, at.q, at.track, 0);
    float q = at.q + to_center_;
    for (int k = 0; k < count; ++k, place = place + step_, q += dq_) {
      WorkList& list = is_interior(q) ? lists_.interior : lists_.edge;
      write(list.blocks[list.count++], place, b0, bj, cells + kBlockFloats * k);
    }
  }
  [[gnu::noinline]] void add_across_tiles(int bj, int b0, int count, RunStart at) {
    const int end = b0 + count;
    while (b0 < end) {
      const int tile_end = (b0 | (kTileBlocksX - 1)) + 1, stop = tile_end < end ? tile_end : end;
      put(bj, b0, stop - b0, at);
      const float n = static_cast<float>(stop - b0);
      at = {at.p + n * dp_, at.q + n * dq_, at.track + n * dt_};
      b0 = stop;
    }
  }

  static constexpr int kBlindBlocks = 4;
  SweepContext& c_;
  WorkLists& lists_;
  const Frame& frame_;
  Flush flush_;
  void* sweep_;
  float interior_, to_center_;
  float dp_, dq_, dt_;
  F4 step_;
};

}  // namespace kerf::KERF_LANES_NAMESPACE
