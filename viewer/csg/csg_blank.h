// viewer/csg/csg_blank.h - the uncut workpiece of the CSG view.
#pragma once

#include <cstdint>

#include "base/geometry.h"
#include "base/result.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// More layers than this are not drawn; each costs as much as the whole picture of a convex blank.
inline constexpr int kMaxConvexity = 8;

struct CsgBlank {
  TriangleMesh mesh;  ///< Closed, mm in the workpiece frame.
  /// Most times that any straight line can enter the mesh. 1 for a box, a cylinder, every convex
  /// body; 2 for a tube or a U. If it is stated too low, parts in the back are missing.
  int convexity = 1;
  std::uint32_t color = 0xffc4bdb8;  ///< 0xAABBGGRR
};

CsgBlank box_blank(const Box& box);

/// Error: no triangles, an index or a coordinate out of range, edges that do not belong to two
/// triangles of opposite direction (corners at equal positions count as one), or a convexity out of
/// 1 .. kMaxConvexity.
Done check(const CsgBlank& blank);

}  // namespace kerf
