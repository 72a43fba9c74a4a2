// stock/octree/dual_contour_tables.h - which crossings of a cell belong to one piece of surface.
#pragma once

#include <array>
#include <cstdint>

namespace kerf {

/// Corners of a cell: number c lies at (c & 1, c >> 1 & 1, c >> 2 & 1). A cell's `signs` has bit c
/// set if corner c is solid.
///
/// Edges: 4 along each axis, x first. Edge 4 * axis + n starts at the corner whose coordinate on
/// the next axis (x after z) is n & 1, and on the one after that n >> 1.
inline constexpr int kDualEdges = 12;
constexpr int dual_edge_axis(int edge) { return edge >> 2; }
constexpr int dual_edge_corner(int edge) {
  const int axis = edge >> 2;
  return (edge & 1) << (axis + 1) % 3 | (edge >> 1 & 1) << (axis + 2) % 3;
}

/// The pieces of surface in a cell. On each face the crossings are joined in pairs; followed from
/// face to face the pairs make closed loops, and each loop is one piece.
struct DualLoops {
  std::uint8_t count = 0;                          ///< 0 .. 4
  std::array<std::uint8_t, 5> begin{};             ///< of each loop in `edges`, and the end
  std::array<std::uint8_t, kDualEdges> edges{};    ///< loop after loop, in order round each
  std::array<std::uint8_t, kDualEdges> loop_of{};  ///< of each crossed edge
};

/// How cells are cut up. Where two solid corners face each other across a face and two empty ones
/// as well, the pairs on that face may be chosen in two ways:
///
///     #-----o        #  solid              #-----o
///     |  /  |        o  empty              |  \  |
///     | / / |  usual                       | \ \ |  other way
///     o-----#                              o-----#
///
/// Both cells at the face must choose alike, and not so that in both of them one loop runs over
/// both pairs: two edges would then join the same two vertices, with four triangles where they lie
/// together. Hence
///   - the usual way, with which that can only happen where the face is the only one of its kind in
///     either cell (checked when this is compiled);
///   - where it is the only one in both, the way that the normals suggest, or if that would join
///     the loops in both cells the other one. It cannot join them in either: changing the way on
///     the face cuts a loop that runs over both pairs in two (checked likewise).
/// So surfaces are 2-manifolds for any signs, and each choice needs no more than the two cells.
/// Cf. Nielson, "Dual marching cubes", 2004; Wenger, "Isosurfaces", 2013, on the manifold variant.
struct DualTables {
  std::array<DualLoops, 512> loops{};  ///< by signs; + kOtherWay with the other way on lone_face
  /// By signs: the only face of that kind (2 * axis, + 1 on the upper side), or kNoFace.
  std::array<std::uint8_t, 256> lone_face{};
  /// As `loops`: whether one loop runs over both pairs of lone_face.
  std::array<std::uint8_t, 512> is_joined{};
  static constexpr int kOtherWay = 256;
  static constexpr std::uint8_t kNoFace = 255;
};
extern const DualTables kDualTables;

}  // namespace kerf
