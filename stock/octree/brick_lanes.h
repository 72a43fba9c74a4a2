// stock/octree/brick_lanes.h - how one sweep is taken from one brick, kLanes points at a time.
//
// Compiled once for each instruction set, as sweep_lanes.h is, and by the same rules.
#pragma once

#include <bit>
#include <cstring>

#include "stock/octree/brick_work.h"
#include "stock/octree/edge_roots.h"
#include "stock/octree/lane_vectors.h"
#include "stock/octree/node_list.h"
#include "stock/octree/sweep_lanes.h"

namespace kerf::octree {
namespace {

/// F is convex, or close to what is: tangent planes tell what it is not less than. Where it is
/// found by iteration they hold to kSweepSlack_mm.
inline bool has_planes(Sweep::Kind kind) { return kind != Sweep::Kind::kArc; }

/// A turning piece's way without the turn.
inline void fix_spindle(Sweep& fixed) {
  fixed.w = fixed.mean_w;
  fixed.bend_mm = 0;
  const ToolBody::Shape shape = fixed.body->shape;
  fixed.kind = shape == ToolBody::Shape::kBall ? Sweep::Kind::kBall : Sweep::Kind::kRamp;
}

/// From a place to the middle of the brick, along an axis.
inline double to_middle(const BrickWork& work, int axis, double place_mm) {
  return 0.5 * (work.place_mm[axis][0] + work.place_mm[axis][kBrick]) - place_mm;
}

/// All of the brick lies below the cylinder of a ball nose, on all of its way: the sphere alone is
/// near.
inline bool sees_sphere(const BrickWork& work, const Sweep& sweep) {
  if (sweep.body->shape != ToolBody::Shape::kBall) return false;
  if (sweep.kind != Sweep::Kind::kBall && sweep.kind != Sweep::Kind::kTurn) return false;
  const Vec3 &o = sweep.origin_mm, &step = sweep.step, &w = sweep.w, &turn = sweep.turn;
  const double x = to_middle(work, 0, o.x), y = to_middle(work, 1, o.y),
               z = to_middle(work, 2, o.z);
  const double first = x * w.x + y * w.y + z * w.z;
  const double last =
      (x - step.x) * (w.x + turn.x) + (y - step.y) * (w.y + turn.y) + (z - step.z) * (w.z + turn.z);
  const double bulge = step.x * turn.x + step.y * turn.y + step.z * turn.z;
  const double most = (first < last ? last : first) + (bulge > 0 ? 0.25 * bulge : 0.0);
  return most + work.half_diagonal_mm + kBlockSlack_mm < 0;
}

/// The sweep as this brick sees it.
inline const Sweep& seen_sweep(BrickWork& work, const Sweep& sweep) {
  if (!sees_sphere(work, sweep)) return sweep;
  work.fixed = sweep;
  work.fixed.kind = Sweep::Kind::kSphere;
  return work.fixed;
}

/// By how much F of a turning piece may differ from that without the turn, in this brick: a body of
/// revolution that turns by an angle about its tip is as if the point moved about that.
inline double off_mean_mm(const BrickWork& work, const Sweep& turning) {
  const auto length = [](double x, double y, double z) {
    return __builtin_sqrt(x * x + y * y + z * z);
  };
  const Vec3 &origin = turning.origin_mm, &step = turning.step;
  const double reach = length(to_middle(work, 0, origin.x), to_middle(work, 1, origin.y),
                              to_middle(work, 2, origin.z)) +
                       work.half_diagonal_mm + length(step.x, step.y, step.z);
  return turning.off_rad * reach;
}

/// Tangent planes in the middles of the blocks.
inline void set_planes(BrickWork& work, const Points& p, const Gradients& g, double off_mm) {
  store_lanes(g.x, work.plane_x);
  store_lanes(g.y, work.plane_y);
  store_lanes(g.z, work.plane_z);
  store_lanes(g.f - (g.x * p.x + g.y * p.y + g.z * p.z) - all(off_mm), work.plane_at);
}

/// How far F may be above its planes, `more_mm` included: that of a ball is a distance from its
/// path and what is above that, which is convex, and bends by no more than 1 / the distance.
inline void set_bends(BrickWork& work, const Sweep& sweep, const Doubles& f, double more_mm) {
  if (sweep.kind != Sweep::Kind::kSphere && sweep.kind != Sweep::Kind::kBall) {
    for (int b = 0; b < 8; ++b) work.bend_mm[b] = kUnbounded;
    return;
  }
  const Doubles distance = f + all(sweep.body->elements[0].radius - sweep.shrink_mm);
  const double reach = work.block_clear_mm;
  const Doubles least = distance - all(reach);
  const Doubles bend = all(0.5 * reach * reach) / least + all(more_mm);
  store_lanes(choose(least < all(reach), all(kUnbounded), bend), work.bend_mm);
}

KERF_LANES Masks is_near(const Doubles& f, double value, double off) {
  return (all(value - off) <= f) & (f <= all(value + off));
}

/// A turning piece's F is dear, that without the turn may be cheap and decide most.
inline bool has_cheap_twin(const BrickWork& work, const Sweep& sweep) {
  return sweep.kind == Sweep::Kind::kTurn && !is_dear(work.fixed.kind);
}

/// What F is not less and not more than in any block, with slack, from F in their middles.
inline void bound_blocks(const BrickWork& work, const Sweep& sweep, const Points& p,
                         const Doubles& f, double* least, double* most) {
  const Doubles clear = all(work.block_clear_mm);
  Doubles low = f - clear, high = f + clear;
  if (has_planes(sweep.kind)) {
    const auto part = [&](const double* normal, int axis) {
      const Doubles n = load_lanes<Doubles>(normal);
      return greater(n, all(0.0) - n) * all(0.5 * kNodeBlock * work.cell_mm[axis]);
    };
    const Doubles reach =
        part(work.plane_x, 0) + part(work.plane_y, 1) + part(work.plane_z, 2) + all(kBlockSlack_mm);
    const Doubles plane =
        load_lanes<Doubles>(work.plane_at) + load_lanes<Doubles>(work.plane_x) * p.x +
        load_lanes<Doubles>(work.plane_y) * p.y + load_lanes<Doubles>(work.plane_z) * p.z;
    low = greater(low, plane - reach);
    high = lesser(high, plane + reach + load_lanes<Doubles>(work.bend_mm));
  }
  store_lanes(low, least);
  store_lanes(high, most);
}

/// Along an axis, of block b by its bit for that.
inline Doubles middles_of_blocks(const BrickWork& work, int axis) {
  constexpr double kIsUpper[3][8] = {
      {0, 1, 0, 1, 0, 1, 0, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}};
  const double* const place = work.place_mm[axis];
  const auto middle = [&](int low) { return all(0.5 * (place[low] + place[low + kNodeBlock])); };
  return choose(all(0.0) < load_lanes<Doubles>(kIsUpper[axis]), middle(kNodeBlock), middle(0));
}

/// Which of the 2 x 2 x 2 blocks F decides at once, as it cannot change faster than by 1 mm a mm.
/// False: none of them is reached.
inline bool sort_blocks(BrickWork& work, const Sweep& sweep) {
  const Points p{middles_of_blocks(work, 0), middles_of_blocks(work, 1),
                 middles_of_blocks(work, 2)};
  const double clear = work.block_clear_mm;
  Gradients g;
  if (sweep.kind == Sweep::Kind::kTurn) {
    work.fixed = sweep;
    fix_spindle(work.fixed);
    evaluate<true>(work.fixed, &p, 1, &g);
    const double off = off_mean_mm(work, sweep);
    set_planes(work, p, g, off);
    work.off_mm = off + 2 * kSweepSlack_mm + kBlockSlack_mm;
    set_bends(work, work.fixed, g.f, off + work.off_mm);
    const auto near = [&](double f) { return is_near(g.f, f, work.off_mm); };
    if (any(near(-clear) | near(clear) | near(clear + kReachMargin_mm)))
      evaluate<false>(sweep, &p, 1, &g);
  } else {
    evaluate<true>(sweep, &p, 1, &g);
    set_planes(work, p, g, 0);
    set_bends(work, sweep, g.f, 0);
  }
  store_lanes(g.f, work.f);
  alignas(64) double least[8], most[8];
  bound_blocks(work, sweep, p, g.f, least, most);
  bool reaches = false;
  for (int b = 0; b < 8; ++b) {
    work.blocks[b] = least[b] > 0  ? BrickWork::kOutside
                     : most[b] < 0 ? BrickWork::kInside
                                   : BrickWork::kMixed;
    if (work.f[b] <= clear + kReachMargin_mm) work.reached |= 1u << b;
    reaches |= work.blocks[b] != BrickWork::kOutside;
  }
  return reaches;
}

/// Node numbers into places.
inline void place_nodes(BrickWork& work, int count) {
  const int room = padded(count);
  for (int n = count; n < room; ++n) work.nodes[n] = 0;
  for (int n = 0; n < room; ++n) {
    const int node = work.nodes[n];
    work.x[n] = work.origin_mm[0] + (work.first[0] + (node >> 4 & 15)) * work.cell_mm[0];
    work.y[n] = work.origin_mm[1] + (work.first[1] + (node >> 8)) * work.cell_mm[1];
    work.z[n] = work.origin_mm[2] + (work.first[2] + (node & 15)) * work.cell_mm[2];
  }
}

/// Takes in F at the listed nodes, which is `off` more or less, and clears nodes. Lists anew those
/// that it does not decide, and returns how many there are.
inline int clear_nodes(BrickWork& work, int points, double off, bool& cleared) {
  int left = 0;
  unsigned any_gone = 0;
  for (int n = 0; n < points; ++n) {
    const std::uint16_t node = work.nodes[n];
    const double most = work.f[n] + off;
    work.node_f[node] = most;
    const unsigned is_gone = most < 0 ? 1u : 0u;
    std::uint16_t& column = work.columns[(node >> 8) * kSide + (node >> 4 & 15)];
    column = static_cast<std::uint16_t>(column & ~(is_gone << (node & 15)));
    any_gone |= is_gone;
    work.nodes[left] = node;
    left += is_gone == 0 && work.f[n] < off ? 1 : 0;
  }
  cleared = cleared || any_gone != 0;
  return left;
}

/// Sets work.columns; true if a node has been cleared.
inline bool find_nodes(BrickWork& work, const Sweep& sweep, const OpenBrick& brick) {
  std::memcpy(work.columns, brick.columns, sizeof work.columns);
  bool cleared = false;
  int points = list_nodes(work, has_planes(sweep.kind), brick, cleared);
  if (points > 0 && has_cheap_twin(work, sweep)) {
    place_nodes(work, points);
    lanes_distance(work.fixed, points, work.x, work.y, work.z, work.f);
    points = clear_nodes(work, points, work.off_mm, cleared);
  }
  place_nodes(work, points);
  lanes_distance(sweep, points, work.x, work.y, work.z, work.f);
  clear_nodes(work, points, 0, cleared);
  return cleared;
}

/// The edges near the sweep: those that were crossed and still are, those that are now, and those
/// that are no more.
inline void sort_edges(BrickWork& work, const OpenBrick& brick) {
  const auto near_of = [&](int block) {
    return static_cast<std::uint16_t>((work.blocks[block] != BrickWork::kOutside ? 0x0f : 0) |
                                      (work.blocks[block + 4] != BrickWork::kOutside ? 0xf0 : 0));
  };
  Words near[2];
  for (int by = 0; by < 2; ++by) near[by] = four_each<Words>(near_of(2 * by), near_of(2 * by + 1));
  for (int j = 0; j < kBrick; ++j) {
    const std::uint16_t* const before = brick.columns + j * kSide;
    const std::uint16_t* const after = work.columns + j * kSide;
    const Words from = load_lanes<Words>(before), to = load_lanes<Words>(after);
    const auto sort = [&](int axis, const Words& next_from, const Words& next_to) {
      const Words was = (from ^ next_from) & near[j / kNodeBlock];
      const Words is = (to ^ next_to) & near[j / kNodeBlock];
      const auto put = [&](const Words& edges, std::uint8_t* bytes) {
        store_lanes(__builtin_convertvector(edges, Bytes), bytes + axis * 64 + j * kBrick);
      };
      put(was & is, work.kept);
      put(is & ~was, work.fresh);
      put(was & ~is, work.lost);
    };
    sort(0, load_lanes<Words>(before + 1), load_lanes<Words>(after + 1));
    sort(1, load_lanes<Words>(before + kSide), load_lanes<Words>(after + kSide));
    sort(2, from >> 1, to >> 1);
  }
}

/// Appends an edge for each bit, with kLowerIsSolid by `columns`. In eights, whatever their number:
/// how many bits a word has is no matter that a processor foresees.
inline void list_edges(const std::uint8_t* bytes, const std::uint16_t* columns, EdgeList& list) {
  static_assert(kPointRoom >= kEdges + W);
  for (int word = 0; word < kEdges / 64; ++word) {
    std::uint64_t bits;
    std::memcpy(&bits, bytes + word * 8, 8);
    if (bits == 0) continue;
    if constexpr (std::endian::native == std::endian::big) bits = __builtin_bswap64(bits);
    const Words row = load_lanes<Words>(columns + word % kBrick * kSide) & 0xff;
    std::uint64_t solid;
    store_lanes(__builtin_convertvector(row, Bytes), &solid);
    if constexpr (std::endian::native == std::endian::big) solid = __builtin_bswap64(solid);
    const int count = __builtin_popcountll(bits);
    std::uint16_t* to = list.edge + list.count;
    list.count += count;
    for (int written = 0; written < count; written += W, to += W) {
      for (int n = 0; n < W; ++n) {
        // Without bits left it is any edge.
        const unsigned at = static_cast<unsigned>(__builtin_ctzll(bits | std::uint64_t{1} << 63));
        const unsigned low = static_cast<unsigned>(solid >> at) & 1u;
        to[n] =
            static_cast<std::uint16_t>(static_cast<unsigned>(word) * 64 + at + low * kLowerIsSolid);
        bits &= bits - 1;
      }
    }
  }
}

/// Air beyond the blank's face stays, where material is added: a crossing is not before the face.
inline double start_of(const BrickWork& work, unsigned edge) {
  if (!work.at_end) return 0;
  const SolidEnd end(edge);
  const int axis = axis_of(edge), at[3] = {end.i, end.j, end.k};
  const int node = work.first[axis] + at[axis];
  return node == 0 || node > work.cells[axis] ? work.cell_mm[axis] / 2 : 0;
}

inline void put(EdgeList& list, int at, std::uint16_t edge, double start, double reach) {
  list.edge[at] = edge;
  list.start[at] = start;
  list.reach[at] = reach;
}

inline void pad(EdgeList& list) {
  for (int n = list.count; n < padded(list.count); ++n) {
    list.edge[n] = 0;
    list.start[n] = list.reach[n] = 0;
  }
}

/// Sets start and reach of edges that are listed from `first` on, by their crossings.
inline void reach_crossings(const BrickWork& work, const OpenBrick& brick, EdgeList& list) {
  pad(list);
  for (int n = 0; n < list.count; n += W) {
    const EdgeLanes edges(list.edge + n);
    std::int32_t places[W];
    for (int l = 0; l < W; ++l) places[l] = brick.place[edge_of(list.edge[n + l])];
    const Ints lower = load_lanes<Ints>(places), upper = all<Ints>(kEdgeParts) - lower;
    Doubles parts;
    widen_to((lower & ~edges.up) | (upper & edges.up), parts);
    store_lanes(edges.length(work) * parts / all(double{kEdgeParts}), list.reach + n);
    store_lanes(all(0.0), list.start + n);
  }
  if (!work.at_end) return;
  int left = 0;
  for (int n = 0; n < list.count; ++n) {
    const double start = start_of(work, list.edge[n]);
    const bool has_way = list.reach[n] > start;
    put(list, left, list.edge[n], start, list.reach[n]);
    left += has_way ? 1 : 0;
  }
  list.count = left;
}

/// Places of the edges' crossings as points.
inline void place_crossings(BrickWork& work, EdgeList& list) {
  pad(list);
  for (int n = 0; n < list.count; n += W) {
    const EdgeLanes edges(list.edge + n);
    const Doubles reach = load_lanes<Doubles>(list.reach + n);
    store_lanes(edges.place(work, 0) + edges.way(0) * reach, work.x + n);
    store_lanes(edges.place(work, 1) + edges.way(1) * reach, work.y + n);
    store_lanes(edges.place(work, 2) + edges.way(2) * reach, work.z + n);
  }
}

/// The value of a block's plane at an edge's crossing, which lies `reach` from its solid end.
inline double plane_at(const BrickWork& work, int block, const SolidEnd& end, unsigned edge,
                       double reach) {
  const EdgeWay& way = kEdgeWays[edge >> 9];
  return work.plane_at[block] +
         work.plane_x[block] * (work.place_mm[0][end.i] + way.along[0] * reach) +
         work.plane_y[block] * (work.place_mm[1][end.j] + way.along[1] * reach) +
         work.plane_z[block] * (work.place_mm[2][end.k] + way.along[2] * reach);
}

/// Where F is dear: may it be less than 0 at the edge's crossing, which lies `reach` from its solid
/// end? By a plane, or by that end, from where F falls by 1 mm a mm at most.
inline bool may_reach(const BrickWork& work, const Sweep& sweep, unsigned edge, double reach) {
  const SolidEnd end(edge);
  const int b = end.block();
  if (has_planes(sweep.kind)) return plane_at(work, b, end, edge, reach) < kBlockSlack_mm;
  return work.blocks[b] != BrickWork::kMixed || work.node_f[end.node()] < reach;
}

/// Lists edges that keep a crossing whose crossing may lie inside of the sweep.
inline void list_kept(BrickWork& work, const Sweep& sweep, const OpenBrick& brick) {
  EdgeList& kept = work.kept_edges;
  kept.count = 0;
  list_edges(work.kept, work.columns, kept);
  reach_crossings(work, brick, kept);
  const bool is_dear_now = is_dear(sweep.kind) && !has_cheap_twin(work, sweep);
  if (work.additive || (!is_dear_now && sweep.kind != Sweep::Kind::kArc)) return;
  int left = 0;
  for (int n = 0; n < kept.count; ++n) {
    const bool may = may_reach(work, sweep, kept.edge[n], kept.reach[n]);
    put(kept, left, kept.edge[n], kept.start[n], kept.reach[n]);
    left += may ? 1 : 0;
  }
  kept.count = left;
}

/// Takes in F at the crossings of kept_edges, which is `off` more or less: deeper ones are pushed
/// to open_edges, those that it does not decide stay listed.
inline void push_deeper(BrickWork& work, double off) {
  EdgeList &kept = work.kept_edges, &open = work.open_edges;
  int left = 0;
  for (int first = 0; first < kept.count; first += W) {
    if (!any(load_lanes<Doubles>(work.f + first) - all(off) < all(-work.place_slack_mm))) continue;
    const int end = first + W < kept.count ? first + W : kept.count;
    for (int n = first; n < end; ++n) {
      const bool is_deeper = work.f[n] + off < -work.place_slack_mm;
      const bool may_be = work.f[n] - off < -work.place_slack_mm;
      const std::uint16_t edge = kept.edge[n];
      const double start = kept.start[n], reach = kept.reach[n];
      put(open, open.count, edge, start, reach);
      open.count += is_deeper ? 1 : 0;
      put(kept, left, edge, start, reach);
      left += may_be && !is_deeper ? 1 : 0;
    }
  }
  kept.count = left;
}

/// Begins open_edges with those whose crossing lies inside of the sweep, by more than a crossing's
/// place is good for, so that a second cut changes nothing.
inline void open_deeper(BrickWork& work, const Sweep& sweep, const OpenBrick& brick) {
  list_kept(work, sweep, brick);
  EdgeList& kept = work.kept_edges;
  work.open_edges.count = 0;
  if (kept.count > 0 && has_cheap_twin(work, sweep)) {
    place_crossings(work, kept);
    lanes_distance(work.fixed, kept.count, work.x, work.y, work.z, work.f);
    push_deeper(work, work.off_mm);
  }
  place_crossings(work, kept);
  lanes_distance(sweep, kept.count, work.x, work.y, work.z, work.f);
  push_deeper(work, 0);
  work.deeper = work.open_edges.count;
}

/// Of the lost edges those that may have a film behind them, by where they are; false if none has.
inline bool sift_lost(const BrickWork& work, const Sweep& sweep, const OpenBrick& brick,
                      std::uint8_t* far) {
  const auto open_of = [&](int block) {
    return static_cast<std::uint8_t>((work.blocks[block] != BrickWork::kInside ? 0x0f : 0) |
                                     (work.blocks[block + 4] != BrickWork::kInside ? 0xf0 : 0));
  };
  // An endless tool that stands upright leaves nothing above.
  const bool takes_roofs = sweep.body->endless && sweep.bottom_mm > -1e300;
  Bytes left = {};
  for (int by = 0; by < 2; ++by) {
    const Bytes open = four_each<Bytes>(open_of(2 * by), open_of(2 * by + 1));
    for (int j = by * kNodeBlock; j < (by + 1) * kNodeBlock; ++j) {
      for (int axis = 0; axis < 3; ++axis) {
        const int row = axis * 64 + j * kBrick;
        Bytes edges = load_lanes<Bytes>(work.lost + row) & open;
        if (axis == 2 && takes_roofs) {
          const Words lower = load_lanes<Words>(brick.columns + j * kSide) & 0xff;
          edges = edges & ~__builtin_convertvector(lower, Bytes);
        }
        store_lanes(edges, far + row);
        left |= edges;
      }
    }
  }
  std::uint64_t bits;
  store_lanes(left, &bits);
  return bits != 0;
}

/// Leaves in lost_edges those whose solid node has gone and whose crossing lies so far outside of
/// the sweep that it may be the far face of a film, with F and its gradient there.
inline void find_lost(BrickWork& work, const Sweep& sweep, const OpenBrick& brick) {
  EdgeList& lost = work.lost_edges;
  lost.count = 0;
  if (!work.seeks_films) return;
  std::uint8_t far[kEdges / 8];
  if (!sift_lost(work, sweep, brick, far)) return;
  list_edges(far, brick.columns, lost);
  reach_crossings(work, brick, lost);
  int left = 0;
  if (is_dear(sweep.kind)) {
    for (int n = 0; n < lost.count; ++n) {
      const SolidEnd end(lost.edge[n]);
      const bool is_within = work.blocks[end.block()] == BrickWork::kMixed &&
                             work.node_f[end.node()] + lost.reach[n] <= kLeastFilm_mm;
      put(lost, left, lost.edge[n], 0, lost.reach[n]);
      left += is_within ? 0 : 1;
    }
    lost.count = left;
  }
  if (lost.count == 0) return;
  place_crossings(work, lost);
  lanes_distance(sweep, lost.count, work.x, work.y, work.z, work.f);
  left = 0;
  for (int n = 0; n < lost.count; ++n) {
    const bool may_be = work.f[n] > kLeastFilm_mm + work.place_slack_mm;
    put(lost, left, lost.edge[n], 0, lost.reach[n]);
    left += may_be ? 1 : 0;
  }
  lost.count = left;
}

inline void open_fresh(BrickWork& work) {
  EdgeList& open = work.open_edges;
  list_edges(work.fresh, work.columns, open);
  pad(open);
  for (int n = work.deeper; n < open.count; n += W) {
    store_lanes(EdgeLanes(open.edge + n).length(work), open.reach + n);
    store_lanes(all(0.0), open.start + n);
  }
  for (int n = work.deeper; work.at_end && n < open.count; ++n)
    open.start[n] = start_of(work, open.edge[n]);
}

/// What a crossing along Z adds to its column's height.
inline std::int32_t height_part(unsigned edge, int place) {
  return (edge & kLowerIsSolid) ? place : kEdgeParts - place;
}

/// Takes over the crossings of the open edges from `first` on.
inline void write_group(BrickWork& work, const Roots& roots, int first, std::uint32_t cut_id,
                        OpenBrick& brick) {
  const EdgeList& open = work.open_edges;
  Crossings found;
  write_crossings(roots, EdgeLanes(open.edge + first), found);
  const int count = open.count - first < W ? open.count - first : W;
  for (int l = 0; l < count; ++l) {
    const unsigned edge = open.edge[first + l];
    const int e = edge_of(edge);
    const bool was = first + l < work.deeper;
    work.removed += (was ? brick.share[e] : 0) - found.share[l];
    if (axis_of(edge) == 2)
      work.heights[e >> 3 & 63] +=
          (was ? height_part(edge, brick.place[e]) : 0) - height_part(edge, found.place[l]);
    brick.place[e] = static_cast<std::uint16_t>(found.place[l]);
    brick.share[e] = found.share[l];
    brick.direction[e] = found.direction[l];
    brick.id[e] = cut_id;
  }
}

/// Finds the crossings of open_edges, and takes them over.
inline void write_open(BrickWork& work, const Sweep& sweep, OpenBrick& brick) {
  EdgeList& open = work.open_edges;
  pad(open);
  const bool enters =
      !work.at_end &&
      (sweep.kind == Sweep::Kind::kSphere ||
       (sweep.body->shape == ToolBody::Shape::kBall && sweep.kind != Sweep::Kind::kArc));
  Roots roots[kRootGroups];
  int firsts[kRootGroups], count = 0;
  const auto search = [&] {
    search_roots(work, sweep, count, roots);
    for (int g = 0; g < count; ++g) write_group(work, roots[g], firsts[g], sweep.cut_id, brick);
    count = 0;
  };
  for (int first = 0; first < open.count; first += W) {
    Roots& r = roots[count];
    begin_roots(work, open, first, r);
    if (enters && !enter(sweep, r)) {
      write_group(work, r, first, sweep.cut_id, brick);
      continue;
    }
    firsts[count++] = first;
    if (count == kRootGroups) search();
  }
  if (count > 0) search();
}

/// Takes the nodes' new state over, and measures what is gone with it.
inline void take_columns(BrickWork& work, OpenBrick& brick) {
  std::memset(work.heights, 0, sizeof work.heights);
  work.removed = 0;
  std::int64_t cleared = 0;
  for (int j = 0; j < kBrick; ++j) {
    constexpr std::size_t kRowBytes = kBrick * sizeof(std::uint16_t);
    if (std::memcmp(brick.columns + j * kSide, work.columns + j * kSide, kRowBytes) == 0) continue;
    for (int i = 0; i < kBrick; ++i) {
      const unsigned before = brick.columns[j * kSide + i], after = work.columns[j * kSide + i];
      cleared += __builtin_popcount((before ^ after) & 0xffu);
      work.heights[j * kBrick + i] = (__builtin_popcount(before & before >> 1 & 0xffu) -
                                      __builtin_popcount(after & after >> 1 & 0xffu)) *
                                     kEdgeParts;
    }
  }
  EdgeList& lost = work.kept_edges;  // which is done with
  lost.count = 0;
  list_edges(work.lost, brick.columns, lost);
  for (int n = 0; n < lost.count; ++n) {
    const unsigned edge = lost.edge[n];
    const int e = edge_of(edge);
    work.removed += brick.share[e];
    if (axis_of(edge) == 2) work.heights[e >> 3 & 63] += height_part(edge, brick.place[e]);
  }
  work.removed += cleared * kNodeVolume;
}

inline void finish(BrickWork& work, OpenBrick& brick) {
  brick.volume -= work.removed;
  for (int c = 0; c < kBrick * kBrick; ++c) brick.height_of[c] -= work.heights[c];
  unsigned any = 0;
  std::memcpy(brick.columns, work.columns, sizeof work.columns);
  for (int c = 0; c < kSide * kSide; ++c) any |= work.columns[c];
  brick.top_node = any == 0 ? -1 : 31 - __builtin_clz(any);
  brick.top_is_known = false;
}

bool brick_remove(BrickWork& work, const Sweep& cutting, OpenBrick& brick) {
  const Sweep& sweep = seen_sweep(work, cutting);
  if (!sort_blocks(work, sweep)) return false;
  const bool cleared = find_nodes(work, sweep, brick);
  sort_edges(work, brick);
  open_deeper(work, sweep, brick);
  if (!cleared && work.open_edges.count == 0) return false;
  find_lost(work, sweep, brick);
  open_fresh(work);
  take_columns(work, brick);
  write_open(work, sweep, brick);
  finish(work, brick);
  if (work.lost_edges.count > 0) {
    place_crossings(work, work.lost_edges);
    lanes_gradient(sweep, work.lost_edges.count, work.x, work.y, work.z, work.f, work.gx, work.gy,
                   work.gz);
  }
  return true;
}

bool brick_meets(BrickWork& work, const Sweep& cutting, const OpenBrick& brick) {
  const Sweep& sweep = seen_sweep(work, cutting);
  if (!sort_blocks(work, sweep)) return false;
  if (find_nodes(work, sweep, brick)) return true;
  sort_edges(work, brick);
  open_deeper(work, sweep, brick);
  return work.open_edges.count > 0;
}

}  // namespace
}  // namespace kerf::octree
