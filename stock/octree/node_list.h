// stock/octree/node_list.h - which nodes of a brick a sweep may clear, eight columns at a time.
//
// Compiled once for each instruction set, as sweep_lanes.h is, and by the same rules.
#pragma once

#include <cstring>

#include "stock/octree/brick_work.h"
#include "stock/octree/lane_vectors.h"

namespace kerf::octree {
namespace {

/// Planes are looked at in floats, from the brick's first node on. What that may be wrong by, in
/// half diagonals of the brick: some ten roundings of numbers that are no more than six of them.
constexpr double kFloatSlack = 4e-6;

/// 2^n: a float's bits are n + 127 times 2^23.
KERF_LANES Floats power_of_two(const Floats& n) {
  Ints bits;
  convert((n + all<Floats>(127.0f)) * all<Floats>(8388608.0f), bits);
  Floats power;
  static_assert(sizeof power == sizeof bits);
  std::memcpy(&power, &bits, sizeof power);
  return power;
}

/// Sets work.column_planes from the planes of the blocks: at the brick's first node; by a cell
/// along X and Y; -1 over what they rise by along Z; sign and offset of bits
/// (ColumnPlanes::nodes()); what F may be more than they are.
inline void set_column_planes(BrickWork& work) {
  const auto get = [](const double* values) { return load_lanes<Doubles>(values); };
  const Doubles x = get(work.plane_x), y = get(work.plane_y), z = get(work.plane_z);
  const double slack = kBlockSlack_mm + kFloatSlack * work.half_diagonal_mm;
  const Doubles step = z * all(work.cell_mm[2]), zero = all(0.0);
  const Masks rises = zero <= step;
  // So little over a brick is far below the slack.
  const Doubles least = choose(rises, greater(step, all(1e-9)), lesser(step, all(-1e-9)));
  int next = 0;
  const auto put = [&](const Doubles& values) {
    Floats narrow;
    narrow_to(values, narrow);
    store_lanes(narrow, work.column_planes[next++]);
  };
  put(get(work.plane_at) + x * all(work.place_mm[0][0]) + y * all(work.place_mm[1][0]) +
      z * all(work.place_mm[2][0]) - all(slack));
  put(x * all(work.cell_mm[0]));
  put(y * all(work.cell_mm[1]));
  put(all(-1.0) / least);
  // Rising: nodes up to where the plane is at 0; else all but those.
  put(choose(rises, all(1.0), all(-1.0)));
  put(choose(rises, all(-1.0), all(double{1 << kSide})));
  put(get(work.bend_mm) + all(2 * slack));
}

/// Tangent planes of two blocks, for four columns each.
struct ColumnPlanes {
  Floats at, x, y;  ///< of the brick's first node, and by a cell along X or Y
  Floats bend;      ///< F may be more than the plane by this
  Floats per_step, sign, offset;

  ColumnPlanes(const BrickWork& work, int left, int right) {
    const auto get = [&](int n) {
      return four_each<Floats>(work.column_planes[n][left], work.column_planes[n][right]);
    };
    at = get(0), x = get(1), y = get(2), per_step = get(3), sign = get(4), offset = get(5);
    bend = get(6);
  }
  /// Bits of nodes that are not surely outside, where the plane has these values at first nodes.
  KERF_LANES void nodes(const Floats& first, Ints& bits) const {
    const Floats zero = all<Floats>(0.0f), most = all<Floats>(float{kSide});
    const Floats steps = all<Floats>(1.0f) + first * per_step;
    const Floats held = choose(steps < zero, zero, choose(steps < most, steps, most));
    Ints whole;
    convert(held, whole);
    Floats count;
    convert(whole, count);
    convert(power_of_two(count) * sign + offset, bits);
  }
};

constexpr std::uint16_t kLowerNodes = 0x00f, kUpperNodes = 0x1f0;

/// Planes of four blocks, two of them above the others, and which nodes these decide.
struct ColumnBlocks {
  ColumnPlanes lower, upper;
  Ints inside, mixed;
  bool any, are_bounded;

  ColumnBlocks(const BrickWork& work, int left, int right)
      : lower(work, left, right), upper(work, left + 4, right + 4) {
    const auto nodes_of = [&](int b, BrickWork::Side side) {
      return (work.blocks[b] == side ? kLowerNodes : 0) |
             (work.blocks[b + 4] == side ? kUpperNodes : 0);
    };
    const auto of = [&](BrickWork::Side side) {
      return four_each<Ints>(nodes_of(left, side), nodes_of(right, side));
    };
    inside = of(BrickWork::kInside);
    mixed = of(BrickWork::kMixed);
    any = any_bits(inside | mixed);
    are_bounded = false;
    for (const int b : {left, right, left + 4, right + 4})
      are_bounded = are_bounded || work.bend_mm[b] < kUnbounded;
  }
  /// Nodes that the planes do not say to be outside, where they have these values at first nodes.
  KERF_LANES Ints nodes(const Floats& lower_first, const Floats& upper_first) const {
    Ints low, high;
    lower.nodes(lower_first, low);
    upper.nodes(upper_first, high);
    return (low & all<Ints>(std::int32_t{kLowerNodes})) |
           (high & all<Ints>(std::int32_t{kUpperNodes}));
  }
};

/// Collects nodes; clears those of blocks that lie inside.
struct NodeList {
  BrickWork& work;
  bool planar;
  int points = 0;
  bool cleared = false;

  /// Columns number, number + stride, ..; `x`, `y`: their places, in cells.
  KERF_LANES void add(const ColumnBlocks& blocks, const Ints& solid, const Floats& x,
                      const Floats& y, int number, int stride) {
    Ints gone = solid & blocks.inside;
    Ints bits = solid & blocks.mixed;
    if (planar && any_bits(bits)) {
      const Floats lower = blocks.lower.at + blocks.lower.x * x + blocks.lower.y * y,
                   upper = blocks.upper.at + blocks.upper.x * x + blocks.upper.y * y;
      bits = bits & blocks.nodes(lower, upper);
      if (blocks.are_bounded && any_bits(bits)) {
        const Ints within =
            bits & blocks.nodes(lower + blocks.lower.bend, upper + blocks.upper.bend);
        gone = gone | within;
        bits = bits & ~within;
      }
    }
    alignas(32) std::int32_t lanes[8];
    if (any_bits(gone)) {
      cleared = true;
      store_lanes(gone, lanes);
      for (int l = 0; l < 8; ++l) {
        std::uint16_t& column = work.columns[number + l * stride];
        column = static_cast<std::uint16_t>(column & ~lanes[l]);
      }
    }
    if (!any_bits(bits)) return;
    store_lanes(bits, lanes);
    // Rows of nodes go along X, the columns beyond them along Y.
    const int first = stride == 1 ? number / kSide << 8 : kBrick << 4;
    const int step = stride == 1 ? 1 << 4 : 1 << 8;
    for (int l = 0; l < 8; ++l)
      if (lanes[l] != 0) list(first + l * step, static_cast<unsigned>(lanes[l]));
  }
  /// A column by itself, in one block and that above it.
  void add_last(const OpenBrick& brick, int column, int block) {
    unsigned solid = brick.columns[column];
    if (work.at_end) solid &= work.may_clear[column];
    unsigned bits = 0;
    for (int k = 0; k < kSide; ++k) {
      const int b = k < kNodeBlock ? block : block + 4;
      const unsigned node = solid & 1u << k;
      if (node == 0 || work.blocks[b] == BrickWork::kOutside) continue;
      if (work.blocks[b] == BrickWork::kInside) {
        work.columns[column] = static_cast<std::uint16_t>(work.columns[column] & ~node);
        cleared = true;
        continue;
      }
      const double plane = work.plane_at[b] + work.plane_x[b] * work.place_mm[0][kBrick] +
                           work.plane_y[b] * work.place_mm[1][kBrick] +
                           work.plane_z[b] * work.place_mm[2][k];
      if (!planar || plane < kBlockSlack_mm) bits |= node;
    }
    list(column / kSide << 8 | column % kSide << 4, bits);
  }
  /// Of the column whose first node that is.
  void list(int node, unsigned bits) {
    for (; bits != 0; bits &= bits - 1)
      work.nodes[points++] = static_cast<std::uint16_t>(node | __builtin_ctz(bits));
  }
};

/// Solid nodes whose F has to be found are listed in work.nodes, those of blocks that lie inside
/// are cleared. `planar`: planes are known. Returns how many are listed.
inline int list_nodes(BrickWork& work, bool planar, const OpenBrick& brick, bool& cleared) {
  set_column_planes(work);
  NodeList list{work, planar};
  const float steps[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const Floats step = load_lanes<Floats>(steps);
  for (int by = 0; by < 2; ++by) {
    const ColumnBlocks blocks(work, 2 * by, 2 * by + 1);
    if (!blocks.any) continue;
    for (int j = by * kNodeBlock; j < (by == 0 ? kNodeBlock : kSide); ++j) {
      Ints solid;
      widen(brick.columns + j * kSide, solid);
      if (work.at_end) {
        Ints may_clear;
        widen(work.may_clear + j * kSide, may_clear);
        solid = solid & may_clear;
      }
      list.add(blocks, solid, step, all<Floats>(static_cast<float>(j)), j * kSide, 1);
    }
  }
  // The columns beyond, of which each row has one.
  const ColumnBlocks blocks(work, 1, 3);
  if (blocks.any) {
    std::uint16_t last[8];
    for (int j = 0; j < kBrick; ++j) {
      const int column = j * kSide + kBrick;
      const unsigned mask = work.at_end ? work.may_clear[column] : kFullColumn;
      last[j] = static_cast<std::uint16_t>(brick.columns[column] & mask);
    }
    Ints solid;
    widen(last, solid);
    list.add(blocks, solid, all<Floats>(float{kBrick}), step, kBrick, kSide);
    list.add_last(brick, kSide * kSide - 1, 3);
  }
  cleared = list.cleared;
  return list.points;
}

}  // namespace
}  // namespace kerf::octree
