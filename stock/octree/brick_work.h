// stock/octree/brick_work.h - what the kernels of brick_lanes.h work on. Plain data: kernels are
// compiled for several instruction sets, and must not share functions of the standard library.
#pragma once

#include <cstdint>

#include "stock/octree/brick.h"
#include "stock/octree/sweep.h"

namespace kerf::octree {

/// What a sweep passes by less than this counts as reached (BrickTree::untouched()): the places of
/// programs are rounded, and so are ways back along the same wall.
inline constexpr double kReachMargin_mm = 0.02;
/// Blocks this close to wholly inside or outside are looked at node by node, so that rounding never
/// decides differently for a block than for its nodes.
inline constexpr double kBlockSlack_mm = 1e-6;
inline constexpr int kNodeBlock = kBrick / 2;
inline constexpr double kUnbounded = 1e30;
/// What is no thicker is no film: positions of programs are rounded.
inline constexpr double kLeastFilm_mm = 0.01;

/// Nodes by number: j << 8 | i << 4 | k. Edges by number: axis * kBrickNodes + node, as OpenBrick
/// has them, and kLowerIsSolid if their solid end is the lower one.
inline constexpr int kNodeNumbers = kSide << 8;
inline constexpr int kEdges = 3 * kBrickNodes;
inline constexpr unsigned kLowerIsSolid = 1u << 11;
/// Points of all edges or nodes, and what lanes overrun.
inline constexpr int kPointRoom = kEdges + 16;

struct EdgeList {
  int count = 0;
  std::uint16_t edge[kPointRoom] = {};
  /// mm from the solid end: the crossing lies between start and reach.
  double start[kPointRoom], reach[kPointRoom];
};

/// One brick and one sweep at a time.
struct BrickWork {
  enum Side : std::uint8_t { kOutside, kInside, kMixed };

  // Of the lattice.
  double origin_mm[3], cell_mm[3];
  int cells[3];
  double block_clear_mm = 0;    ///< half a block's diagonal, and slack
  double half_diagonal_mm = 0;  ///< of the brick
  double place_slack_mm = 0;    ///< what a crossing's place is good for
  bool additive = false, seeks_films = false;

  // Of the brick.
  int first[3] = {0, 0, 0};  ///< node
  double place_mm[3][16] = {};
  bool at_end = false;  ///< some nodes are outside of the blank
  std::uint16_t may_clear[kSide * kSide];
  unsigned reached = 0;  ///< blocks that any sweep has come near

  // Of the sweep.
  Sweep fixed;  ///< of a turning piece: its way without the turn, or the sphere of a ball
  double off_mm =
      0;  ///< F without the turn differs by at most this in the brick, as both are found
  Side blocks[8];
  std::uint16_t columns[kSide * kSide];  ///< after it
  int cleared = 0;                       ///< own nodes that it takes
  /// F in the brick is nowhere less than at + x, y, z . place of any block; where that is known.
  double plane_at[8], plane_x[8], plane_y[8], plane_z[8];
  /// Of balls: F in a block is nowhere more than its plane and this. kUnbounded: who knows.
  double bend_mm[8];
  /// The same planes as columns of nodes see them, in floats (node_list.h), [what][block].
  alignas(32) float column_planes[7][8];
  double node_f[kNodeNumbers];  ///< F at solid nodes of mixed blocks, or a bound below it
  /// Edges by their bytes, [axis][j][i]: crossed before and after, only after, only before.
  std::uint8_t kept[kEdges / 8], fresh[kEdges / 8], lost[kEdges / 8];
  EdgeList kept_edges, open_edges, lost_edges;
  int deeper = 0;  ///< the first of open_edges had crossings before

  // What the sweep has removed: volume in kNodeVolume, height by column in kEdgeParts.
  std::int64_t removed = 0;
  std::int32_t heights[kBrick * kBrick];

  // Points.
  std::uint16_t nodes[kPointRoom] = {};
  alignas(64) double x[kPointRoom] = {}, y[kPointRoom] = {}, z[kPointRoom] = {};
  alignas(64) double f[kPointRoom], gx[kPointRoom], gy[kPointRoom], gz[kPointRoom];
};

}  // namespace kerf::octree
